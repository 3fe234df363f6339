#pragma once

#include <QStringList>

namespace hermes::simulator {

/// What sim.fault can make fail: the lidar, the lines and controllers of the motors, the battery, the wheels.
QStringList faultDevices();
/// All that any of them can do wrong, with "none".
QStringList faultKinds();
/// Why the device has no such fault, or an empty text.
QString faultMismatch(const QString &device, const QString &kind);
/// Of a wheel by its name, in the order of WheelBase; -1 for other devices.
int wheelNumber(const QString &device);

} // namespace hermes::simulator
