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

FixReport reportOf(const nmea::Gga &gga) {
    FixReport report;
    report.kind = FixReport::Kind::Gga;
    report.time = gga.time;
    report.valid = gga.quality > 0;
    report.position = gga.position;
    report.quality = gga.quality;
    report.satellites = gga.satellites;
    report.hdop = gga.hdop;
    report.altitude = gga.altitude;
    return report;
}

FixReport reportOf(const nmea::Gns &gns) {
    FixReport report;
    report.kind = FixReport::Kind::Gns;
    report.time = gns.time;
    if (gns.quality)
        report.valid = *gns.quality > 0;
    report.position = gns.position;
    report.quality = gns.quality;
    report.satellites = gns.satellites;
    report.hdop = gns.hdop;
    report.altitude = gns.altitude;
    return report;
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
