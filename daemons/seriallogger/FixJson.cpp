#include "daemons/seriallogger/FixJson.h"

namespace hermes {

namespace {

template <typename T>
QJsonValue orNull(const std::optional<T> &value) {
    return value ? QJsonValue(*value) : QJsonValue();
}

} // namespace

QJsonObject toJson(const Fix &fix) {
    return {{"stamp", fix.arrival.stamp()},
            {"mono", fix.arrival.mono()},
            {"time", orNull(fix.time)},
            {"valid", fix.valid},
            {"lat_deg", fix.position ? QJsonValue(fix.position->latitude_deg) : QJsonValue()},
            {"lon_deg", fix.position ? QJsonValue(fix.position->longitude_deg) : QJsonValue()},
            {"alt", orNull(fix.altitude)},
            {"quality", orNull(fix.quality)},
            {"satellites", orNull(fix.satellites)},
            {"hdop", orNull(fix.hdop)},
            {"speed", orNull(fix.speed)},
            {"course_deg", orNull(fix.course_deg)}};
}

} // namespace hermes
