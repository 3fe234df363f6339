#pragma once

#include "daemons/simulator/DeviceLines.h"
#include "daemons/simulator/PacketPump.h"
#include "protocol/messages/Motion.h"

#include <QStringList>

#include <optional>

namespace hermes::simulator {

/// What sim.fault can make fail: the lidar, the other sensors, the lines and controllers of the motors, the
/// battery, the wheels.
QStringList faultDevices();
/// All that any of them can do wrong, with "none".
QStringList faultKinds();
/// Why the device of a robot that is driven so has no such fault, or an empty text.
QString faultMismatch(const QString &device, const QString &kind, const MotorKind &motors);
/// What it can do wrong; of GPS receiver and scanner in the order of their Fault::Kind, from Silence on.
QStringList faultKindsOf(const QString &device);
/// Of a wheel by its name, in the order of WheelBase; -1 for other devices.
int wheelNumber(const QString &device);

/// A world that was read.
struct LoadedWorld {
    QString path, name;
    quint64 edges = 0, poses = 0;
};

/// A simulated motor controller.
struct EmulatorState {
    std::optional<quint32> status; ///< as the temperature, of a RoboClaw
    std::optional<double> temperature_c;
    double timeout_s = 0;
    MotorEmulator::Counts counts;
};

/// What drives the simulated robot; without a world there are its lines only.
struct DrivetrainState {
    std::optional<std::array<double, 4>> wheels_rps;
    std::optional<std::vector<EmulatorState>> controllers;
    std::optional<double> battery_v, batteryCharge;
    std::vector<LineState> lines;
};

/// A fault of the lidar that was asked for.
struct FaultState {
    QString kind;
    double share = 0;
};

/// The simulated 2D scanner.
struct ScannerState {
    QString model = "none";
    SensorLineState line;
    quint64 revolutions = 0;
};

/// What sim.state gives.
struct SimulatorState {
    QString world;
    double stamp = 0;
    Pose2D pose;
    Twist2D twist;
    double progress = 0;
    bool driving = false, finished = false, placed = false, touching = false;
    DrivetrainState motors;
    SensorLineState gps;
    ScannerState scanner;
    LidarModel::Options lidar;
    FaultState fault;
    PacketPump::Counts packets;
};

Fields<LoadedWorld> fieldsOf(Of<LoadedWorld>);
Fields<PacketPump::Counts> fieldsOf(Of<PacketPump::Counts>);
Fields<SimulatorState> fieldsOf(Of<SimulatorState>);

} // namespace hermes::simulator
