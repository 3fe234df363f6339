#include "daemons/simulator/SimulatorMessages.h"
#include "protocol/wire/Fields.h"

#include <array>

namespace hermes::simulator {

namespace {

constexpr std::array<const char *, 4> wheels{"front_left", "front_right", "rear_left", "rear_right"};
QStringList faultsOf(const MotorKind &motors) {
    return QStringList(motors.faults.begin(), motors.faults.end());
}
const QStringList ofController = faultsOf(motorKind("roboclaw"));
const QStringList ofSecond{"line2", "controller2", "controllers"};
const QStringList ofWheel{"blocked", "encoder", "jump", "backward"};

struct Device {
    QString name;
    QStringList kinds;
};
const QList<Device> devices{
    {"lidar", {"silence", "loss"}},
    {"gps", {"silence", "no_fix", "corrupt", "pulled"}},
    {"scanner", {"silence", "corrupt", "loss", "stalled", "health", "held", "pulled"}},
    {"line1", {"pulled", "adapter"}},
    {"line2", {"pulled", "adapter"}},
    {"controller1", ofController},
    {"controller2", ofController},
    {"controllers", {"swapped"}},
    {"battery", {"charge"}},
    {"wheels", {"slip"}},
    {wheels[0], ofWheel},
    {wheels[1], ofWheel},
    {wheels[2], ofWheel},
    {wheels[3], ofWheel}};

} // namespace

QStringList faultDevices() {
    QStringList names;
    for (const Device &device : devices)
        names.append(device.name);
    return names;
}

QStringList faultKinds() {
    QStringList kinds{"none"};
    for (const Device &device : devices)
        kinds += device.kinds;
    for (const MotorKind &motors : motorKinds())
        kinds += faultsOf(motors);
    kinds.removeDuplicates();
    return kinds;
}

QStringList faultKindsOf(const QString &device) {
    for (const Device &known : devices) {
        if (known.name == device)
            return known.kinds;
    }
    return {};
}

QString faultMismatch(const QString &device, const QString &kind, const MotorKind &motors) {
    if (motors.controllers < 2 && ofSecond.contains(device))
        return QString("a robot with %1 has no %2").arg(motors.title, device);
    const bool isController = device == "controller1" || device == "controller2";
    const QStringList kinds = isController ? faultsOf(motors) : faultKindsOf(device);
    if (kind == "none" || kinds.contains(kind))
        return {};
    return QString("%1 has no fault %2; it has: none, %3").arg(device, kind, kinds.join(", "));
}

int wheelNumber(const QString &device) {
    for (std::size_t i = 0; i < wheels.size(); ++i) {
        if (device == wheels[i])
            return int(i);
    }
    return -1;
}

Fields<LoadedWorld> fieldsOf(Of<LoadedWorld>) {
    return Fields<LoadedWorld>()
        .add("path", &LoadedWorld::path, "Of the file, absolute")
        .add("name", &LoadedWorld::name, "Of the world")
        .add("edges", &LoadedWorld::edges, "Walls")
        .add("poses", &LoadedWorld::poses, "Of its path");
}

Fields<MotorEmulator::Counts> fieldsOf(Of<MotorEmulator::Counts>) {
    using C = MotorEmulator::Counts;
    return Fields<C>()
        .add("requests", &C::requests, "Carried out")
        .add("crc_errors", &C::crcErrors, "Damaged requests")
        .add("unknown", &C::unknown, "Bytes of no request")
        .add("timeouts", &C::timeouts, "Times that silence stopped the motors");
}

Fields<EmulatorState> fieldsOf(Of<EmulatorState>) {
    using E = EmulatorState;
    return Fields<E>()
        .add("status", &E::status, "Bits of errors and warnings, of a RoboClaw")
        .add("temperature_c", &E::temperature_c, "Of a RoboClaw", "degC")
        .add("serial_timeout_s", &E::timeout_s, "It stops then; 0: never", "s")
        .include(&E::counts);
}

Fields<LineState> fieldsOf(Of<LineState>) {
    return Fields<LineState>()
        .add("link", &LineState::link, "That stays the same, or empty")
        .add("device", &LineState::device, "Its path, or where it listens; empty while it is pulled");
}

Fields<SensorLineState> fieldsOf(Of<SensorLineState>) {
    using G = SensorLineState;
    return Fields<G>()
        .include(&G::line)
        .add("bytes", &G::bytes, "Sent", "byte")
        .add("unread_lost", &G::unreadLost, "That no program has read in time", "byte");
}

Fields<ScannerState> fieldsOf(Of<ScannerState>) {
    using S = ScannerState;
    return Fields<S>()
        .add("model", &S::model, "none, or its model")
        .include(&S::line)
        .add("revolutions", &S::revolutions, "Of its head");
}

Fields<DrivetrainState> fieldsOf(Of<DrivetrainState>) {
    using D = DrivetrainState;
    return Fields<D>()
        .add("wheels_rps", &D::wheels_rps, "Front left, front right, rear left, rear right, forward", "rad/s")
        .add("controllers", &D::controllers, "Each")
        .add("battery_v", &D::battery_v, "Voltage", "V")
        .add("battery_charge", &D::batteryCharge, "0 to 1")
        .add("lines", &D::lines, "Pseudo-terminals of the controllers");
}

Fields<LidarModel::Options> fieldsOf(Of<LidarModel::Options>) {
    using L = LidarModel::Options;
    return Fields<L>()
        .add("sigma_m", &L::sigma, "Standard deviation of the lidar's range", "m")
        .add("dropouts", &L::dropouts, "Share of its returns that do not come")
        .add("outliers", &L::outliers, "Share that comes from anywhere");
}

Fields<FaultState> fieldsOf(Of<FaultState>) {
    return Fields<FaultState>()
        .add("kind", &FaultState::kind, "What the lidar does wrong")
        .choices({"none", "silence", "loss"})
        .add("share", &FaultState::share, "Of the packets that a loss leaves out");
}

Fields<PacketPump::Counts> fieldsOf(Of<PacketPump::Counts>) {
    using C = PacketPump::Counts;
    return Fields<C>()
        .add("packets", &C::sent, "Sent")
        .add("position_packets", &C::positions, "Sent besides")
        .add("swallowed", &C::swallowed, "By a fault that was asked for")
        .add("skipped", &C::skipped, "Not made, because the machine stalled")
        .add("send_errors", &C::sendErrors, "Packets that the system did not take")
        .add("worst_lag_s", &C::worstLag_s, "By which one was late", "s");
}

Fields<SimulatorState> fieldsOf(Of<SimulatorState>) {
    using S = SimulatorState;
    return Fields<S>()
        .add("world", &S::world, "File, or empty")
        .add("stamp", &S::stamp, "On the clock of the lidar's stamps", "s")
        .add("pose", &S::pose, "Where the robot truly is")
        .add("twist", &S::twist, "How it truly moves")
        .add("progress", &S::progress, "Share of the path behind the robot")
        .add("driving", &S::driving, "It follows the path")
        .add("finished", &S::finished, "It is at the end of the path")
        .add("placed", &S::placed, "It was placed off the path")
        .add("touching", &S::touching, "A wall or a person holds it")
        .add("motors", &S::motors, "What drives it")
        .add("gps", &S::gps, "Line of the GPS receiver")
        .add("scanner", &S::scanner, "The 2D laser scanner and its line")
        .include(&S::lidar)
        .add("fault", &S::fault, "Of the lidar")
        .include(&S::packets);
}

} // namespace hermes::simulator
