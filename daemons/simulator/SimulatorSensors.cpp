#include "common/Log.h"
#include "daemons/simulator/Simulator.h"
#include "daemons/simulator/SimulatorSettings.h"

namespace hermes::simulator {

namespace {

constexpr double patience_s = 0.3; // then what a program has not read is lost

} // namespace

Result<void> Simulator::openScanner(const SimulatorSettings &wanted) {
    scannerModel_ = wanted.scannerModel;
    const std::unique_ptr<ScannerEmulator> scanner = makeScanner(scannerModel_.toStdString());
    if (!scanner)
        return {};
    const auto received = [this](const QByteArray &bytes) {
        pump_.with([&](Simulation &simulation) {
            if (!simulation.scanner())
                return;
            if (bytes.isEmpty()) {
                simulation.scanner()->disconnect();
                ++scannerSession_;
            } else {
                simulation.scanner()->receive(bytes.toStdString(), simulation.now_ns());
            }
        });
        if (bytes.isEmpty())
            pump_.dropScannerBytes();
    };
    if (wanted.scannerPort > 0)
        return scannerLine_.listen(wanted.scannerPort, received);
    return scannerLine_.open(wanted.scannerLink, scanner->model().baud, patience_s, received);
}

Result<void> Simulator::setSensorFault(const Call &call) {
    const QString device = call.text("device"), kind = call.text("kind");
    const bool gps = device == "gps";
    if (!gps && scannerModel_ == "none")
        return Error(ErrorCode::NotReady, "the robot has no scanner; scanner.model gives it one");
    if (!gps && kind == "health" && !makeScanner(scannerModel_.toStdString())->tellsHealth()) {
        QStringList others = faultKindsOf(device);
        others.removeAll(kind);
        return invalidParams(
            {{"kind", kind, "a fault of this scanner"}},
            QString("%1 has no fault health; it has: none, %2").arg(scannerModel_, others.join(", ")));
    }
    if (kind == "pulled" || kind == "none")
        (gps ? gpsLine_ : scannerLine_).setPulled(kind == "pulled");
    if (kind != "pulled") {
        if (worldPath_.isEmpty() && kind != "none")
            return Error(ErrorCode::NotReady, "no world is loaded; sim.load loads one");
        const auto number = faultKindsOf(device).indexOf(kind) + 1;
        const double share = call.number("share");
        pump_.with([&](Simulation &simulation) {
            if (gps)
                simulation.gps().setFault({GpsModel::Fault::Kind(number), share});
            else if (simulation.scanner())
                simulation.scanner()->setFault({ScannerEmulator::Fault::Kind(number), share});
        });
    }
    logInfo("simulator", "fault of the " + device + ": " + kind);
    return {};
}

} // namespace hermes::simulator
