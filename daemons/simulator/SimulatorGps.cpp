#include "common/Log.h"
#include "daemons/simulator/Simulator.h"

namespace hermes::simulator {

Result<void> Simulator::setGpsFault(const Call &call) {
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
    return {};
}

} // namespace hermes::simulator
