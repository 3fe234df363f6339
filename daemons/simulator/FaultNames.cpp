#include "daemons/simulator/FaultNames.h"

#include <array>

namespace hermes::simulator {

namespace {

constexpr std::array<const char *, 4> wheels{"front_left", "front_right", "rear_left", "rear_right"};
const QStringList ofController{"silence",       "loss",     "corrupt",        "slow",
                               "deaf",          "mute",     "latched",        "echo",
                               "stuck_timeout", "brownout", "emergency_stop", "over_temperature",
                               "over_current",  "driver"};
const QStringList ofWheel{"blocked", "encoder", "jump", "backward"};

struct Device {
    QString name;
    QStringList kinds;
};
const QList<Device> devices{{"lidar", {"silence", "loss"}},
                            {"gps", {"silence", "no_fix", "corrupt", "pulled"}},
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
    kinds.removeDuplicates();
    return kinds;
}

QString faultMismatch(const QString &device, const QString &kind) {
    for (const Device &known : devices) {
        if (known.name == device && kind != "none" && !known.kinds.contains(kind))
            return QString("%1 has no fault %2; it has: none, %3").arg(device, kind, known.kinds.join(", "));
    }
    return {};
}

int wheelNumber(const QString &device) {
    for (std::size_t i = 0; i < wheels.size(); ++i) {
        if (device == wheels[i])
            return int(i);
    }
    return -1;
}

} // namespace hermes::simulator
