#include "daemons/seriallogger/FixReport.h"

#include "protocol/nmea/Gga.h"
#include "protocol/nmea/Gll.h"
#include "protocol/nmea/Gns.h"
#include "protocol/nmea/Rmc.h"
#include "protocol/nmea/Vtg.h"
#include "protocol/nmea/Zda.h"

namespace hermes::seriallogger {

namespace {

FixReport reportOf(const nmea::Rmc &rmc) {
    FixReport report;
    report.kind = FixReport::Kind::Rmc;
    report.time = rmc.time;
    report.date = rmc.date;
    report.valid = rmc.valid;
    report.position = rmc.position;
    report.speed = rmc.speed;
    report.course_deg = rmc.course_deg;
    return report;
}

/// Of GGA and GNS.
template <typename Message>
FixReport withQuality(FixReport::Kind kind, const Message &message) {
    FixReport report;
    report.kind = kind;
    report.time = message.time;
    report.position = message.position;
    report.quality = message.quality;
    if (report.quality)
        report.valid = *report.quality > 0;
    report.satellites = message.satellites;
    report.hdop = message.hdop;
    report.altitude = message.altitude;
    return report;
}

FixReport reportOf(const nmea::Gga &gga) {
    return withQuality(FixReport::Kind::Gga, gga);
}

FixReport reportOf(const nmea::Gns &gns) {
    return withQuality(FixReport::Kind::Gns, gns);
}

FixReport reportOf(const nmea::Gll &gll) {
    FixReport report;
    report.kind = FixReport::Kind::Gll;
    report.time = gll.time;
    report.valid = gll.valid;
    report.position = gll.position;
    return report;
}

FixReport reportOf(const nmea::Vtg &vtg) {
    FixReport report;
    report.kind = FixReport::Kind::Vtg;
    report.speed = vtg.speed;
    report.course_deg = vtg.course_deg;
    return report;
}

FixReport reportOf(const nmea::Zda &zda) {
    FixReport report;
    report.kind = FixReport::Kind::Zda;
    report.time = zda.time;
    report.date = zda.date;
    return report;
}

template <typename Message>
std::optional<FixReport> readAs(const nmea::Sentence &sentence, nmea::FieldFault &fault) {
    Message message;
    fault = decode(sentence, message);
    return fault ? std::nullopt : std::optional(reportOf(message));
}

} // namespace

std::optional<FixReport> FixReport::read(const nmea::Sentence &sentence, nmea::FieldFault &fault) {
    fault = {};
    const std::string_view type = sentence.type();
    if (type == "RMC")
        return readAs<nmea::Rmc>(sentence, fault);
    if (type == "GGA")
        return readAs<nmea::Gga>(sentence, fault);
    if (type == "GNS")
        return readAs<nmea::Gns>(sentence, fault);
    if (type == "GLL")
        return readAs<nmea::Gll>(sentence, fault);
    if (type == "VTG")
        return readAs<nmea::Vtg>(sentence, fault);
    if (type == "ZDA")
        return readAs<nmea::Zda>(sentence, fault);
    return std::nullopt;
}

} // namespace hermes::seriallogger
