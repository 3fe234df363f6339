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
    return scannerLine_.open(
        wanted.scannerLink, scanner->model().baud, patience_s, [this](const QByteArray &bytes) {
            pump_.with([&](Simulation &simulation) {
                if (simulation.scanner())
                    simulation.scanner()->receive(bytes.toStdString(), simulation.now_ns());
            });
        });
}

Result<void> Simulator::setScannerFault(const Call &call) {
    const QString kind = call.text("kind");
    if (scannerModel_ == "none")
        return Error(ErrorCode::NotReady, "the robot has no scanner; scanner.model gives it one");
    if (kind == "pulled" || kind == "none")
        scannerLine_.setPulled(kind == "pulled");
    if (kind != "pulled") {
        if (worldPath_.isEmpty() && kind != "none")
            return Error(ErrorCode::NotReady, "no world is loaded; sim.load loads one");
        const auto number = scannerFaultKinds().indexOf(kind) + 1;
        pump_.with([&](Simulation &simulation) {
            if (simulation.scanner())
                simulation.scanner()->setFault({ScannerEmulator::Fault::Kind(number), call.number("share")});
        });
    }
    logInfo("simulator", "fault of the scanner: " + kind);
    return {};
}

} // namespace hermes::simulator
