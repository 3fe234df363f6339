#include "gui/setup/WheelSettings.h"

#include <algorithm>

namespace hermes {

const QStringList &wheelNames() {
    static const QStringList names{"front_left", "front_right", "rear_left", "rear_right"};
    return names;
}

Result<WheelPlan> WheelPlan::from(const QJsonObject &settings, const QJsonObject &state) {
    if (!settings["wheels"].isObject())
        return Error(ErrorCode::InvalidSetting, "the motor control has no settings \"wheels\"");
    const QString layout = settings["frame"]["layout"].toString();
    if (layout.startsWith("omni"))
        return Error(
            ErrorCode::InvalidSetting,
            QString("frame.layout is %1: its wheels have no forward to ask for. Test them by hand: a "
                    "wheel with a positive speed of motor.wheels turns the robot "
                    "counter-clockwise, else set its wheels.NAME.reversed")
                .arg(layout));
    QStringList wheels = wheelNames();
    wheels.erase(std::remove_if(wheels.begin(), wheels.end(),
                                [&](const QString &wheel) { return !state["wheels"][wheel].isObject(); }),
                 wheels.end());
    if (wheels.isEmpty())
        return Error(ErrorCode::InvalidSetting, "motor.state names no wheel, expected one at least");
    return WheelPlan{settings["wheels"].toObject(), wheels,
                     std::max(1.0, settings["faults"]["encoder_commanded_rad_s"].toDouble())};
}

Result<QJsonObject> wheelSettings(const QJsonObject &now, const std::map<QString, SeenWheel> &seen) {
    QJsonObject wheels;
    for (const auto &[told, what] : seen) {
        if (what.wheel.isEmpty())
            return Error(
                ErrorCode::DeviceFault,
                QString("no wheel turned for %1: check the power and the wires of that motor").arg(told));
        if (wheels.contains(what.wheel))
            return Error(
                ErrorCode::DeviceFault,
                QString("%1 turned for two of the wheels: no settings follow from that").arg(what.wheel));
        QJsonObject wheel = now[told].toObject();
        wheel["reversed"] = wheel["reversed"].toBool() != what.isBackward;
        wheels[what.wheel] = wheel;
    }
    QJsonObject changes;
    for (const QString &wheel : wheels.keys())
        if (wheels[wheel] != now[wheel])
            changes[wheel] = wheels[wheel];
    return changes;
}

} // namespace hermes
