#pragma once

#include "common/daemon/Daemon.h"
#include "daemons/simulator/PacketPump.h"

namespace hermes {

/// hermes-simulator: a robot in a world file, with an HDL-32E that sends its packets over UDP.
class Simulator : public Daemon {
public:
    Simulator();

protected:
    Result<void> start() override;
    void stop() override { pump_.stop(); }
    void settingsChanged(const QStringList &paths) override;

private:
    void declareSettings();
    void declareTopics();
    void declareCommands();

    Simulation::Options options();
    /// Puts the robot at the first pose of a world file and begins to send.
    Result<void> load(const QString &path);
    Result<QJsonValue> drive(bool restart);
    Result<QJsonValue> place(const Call &call);
    Result<QJsonValue> setNoise(const Call &call);
    Result<QJsonValue> setFault(const Call &call);
    QJsonObject state();
    void publishTruth(const Simulation::Truth &truth);
    void updateHealth();

    PacketPump pump_;
    World world_;
    QString worldPath_;
};

} // namespace hermes
