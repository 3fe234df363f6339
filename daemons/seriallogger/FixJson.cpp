#include "daemons/seriallogger/FixJson.h"

namespace hermes {

namespace {

template <typename T>
QJsonValue orNull(const std::optional<T> &value) {
    return value ? QJsonValue(*value) : QJsonValue();
}

} // namespace

QJsonObject toJson(const Fix &fix) {
    const nmea::Rmc rmc = fix.rmc.value_or(nmea::Rmc());
    const nmea::Gga gga = fix.gga.value_or(nmea::Gga());
    const std::optional<nmea::Position> position = fix.position();
    return {{"stamp", fix.arrival.stamp()},
            {"mono", fix.arrival.mono()},
            {"time", orNull(fix.time())},
            {"valid", fix.isValid()},
            {"lat_deg", position ? QJsonValue(position->latitude_deg) : QJsonValue()},
            {"lon_deg", position ? QJsonValue(position->longitude_deg) : QJsonValue()},
            {"alt", orNull(gga.altitude)},
            {"quality", fix.gga ? QJsonValue(gga.quality) : QJsonValue()},
            {"satellites", orNull(gga.satellites)},
            {"hdop", orNull(gga.hdop)},
            {"speed", orNull(rmc.speed)},
            {"course_deg", orNull(rmc.course_deg)}};
}

} // namespace hermes
