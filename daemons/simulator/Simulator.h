#pragma once

#include "common/daemon/Daemon.h"
#include "common/daemon/PastFaults.h"
#include "daemons/simulator/DeviceLines.h"
#include "daemons/simulator/SimulatorMessages.h"

namespace hermes::simulator {

/// hermes-simulator: a robot in a world file, with an HDL-32E that sends its packets over UDP, motor
/// controllers that drive it, a GPS receiver and a 2D laser scanner on pseudo-terminals.
struct SimulatorSettings;

class Simulator : public Daemon {
public:
    Simulator();

protected:
    Result<void> start() override;
    void stop() override {
        lines_.close();
        pump_.stop();
        gpsLine_.close();
        scannerLine_.close();
    }
    void settingsChanged(const QStringList &paths) override;

private:
    void declareTopics();
    void declareCommands();

    /// Puts the robot at the first pose of a world file and begins to send.
    Result<void> loadNamed(const QString &name, const QStringList &folders);
    Result<void> load(const QString &path, const Outcome<World> &world);
    Result<void> drive(bool restart);
    Result<void> place(const Call &call);
    Result<void> setNoise(const Call &call);
    Result<void> setFault(const Call &call);
    Result<void> setMotorFault(const Call &call);
    /// Of the GPS receiver or the 2D scanner.
    Result<void> setSensorFault(const Call &call);
    Result<void> openScanner(const SimulatorSettings &wanted);
    DrivetrainState motorState(Drivetrain &drivetrain) const;
    SimulatorState state();
    void publishTruth(const Simulation::Truth &truth);
    void updateHealth();
    /// In this thread.
    void later(const std::function<void()> &function) {
        QMetaObject::invokeMethod(this, function, Qt::QueuedConnection);
    }

    PacketPump pump_;
    PastFaults faults_;
    MotorLines lines_;
    SensorLine gpsLine_, scannerLine_;
    QString scannerModel_ = "none";
    int scannerSession_ = 0; ///< of programs on its network, one after another; guarded by the pump
    World world_;
    QString worldPath_;
};

} // namespace hermes::simulator
