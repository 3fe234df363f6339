#include "common/Log.h"
#include "daemons/simulator/Simulator.h"

namespace hermes::simulator {

void Simulator::declareGpsSettings() {
    addSetting(Field::text("gps.link",
                           "Link to the pseudo-terminal of the GPS receiver; none: sim.state tells "
                           "its name")
                   .byDefault("")
                   .appliesOnRestart()
                   .group("GPS"));
    addSetting(Field::integer("gps.rate_hz", "Fixes a second")
                   .unit("Hz")
                   .range(1, 10)
                   .byDefault(5)
                   .appliesOnRestart()
                   .group("GPS"));
    addNumber("GPS", "gps.latitude_deg", "Of the world's origin, north positive; x points east, y north",
              "deg", -89, 89, 50);
    addNumber("GPS", "gps.longitude_deg", "Of the world's origin, east positive", "deg", -180, 180, 10);
    addNumber("GPS", "gps.altitude_m", "Of the receiver above the sea", "m", -500, 9000, 300);
    addSetting(Field::number("gps.sigma_m", "Standard deviation of each coordinate of a fix")
                   .unit("m")
                   .range(0, 1000)
                   .byDefault(0.5)
                   .group("GPS"));
}

GpsModel::Options Simulator::gpsOptions() {
    const Settings &values = settings();
    GpsModel::Options options;
    options.origin = {values.number("gps.latitude_deg"), values.number("gps.longitude_deg")};
    options.altitude = values.number("gps.altitude_m");
    options.sigma = values.number("gps.sigma_m");
    options.rate_hz = int(values.integer("gps.rate_hz"));
    options.seed = std::uint64_t(values.number("seed"));
    return options;
}

Result<QJsonValue> Simulator::setGpsFault(const Call &call) {
    const QString kind = call.text("kind");
    if (kind == "pulled" || kind == "none")
        gpsLine_.setPulled(kind == "pulled");
    if (kind != "pulled") {
        if (worldPath_.isEmpty() && kind != "none")
            return Error(ErrorCode::NotReady, "no world is loaded; sim.load loads one");
        GpsModel::Fault fault;
        if (kind == "silence")
            fault.kind = GpsModel::Fault::Kind::Silence;
        else if (kind == "no_fix")
            fault.kind = GpsModel::Fault::Kind::NoFix;
        else if (kind == "corrupt")
            fault = {GpsModel::Fault::Kind::Corrupt, call.number("share")};
        pump_.with([&](Simulation &simulation) { simulation.gps().setFault(fault); });
    }
    logInfo("simulator", "fault of the gps: " + kind);
    return QJsonValue();
}

} // namespace hermes::simulator
