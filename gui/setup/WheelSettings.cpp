#include "gui/setup/WheelSettings.h"

namespace hermes {

const QStringList &wheelNames() {
    static const QStringList names{"front_left", "front_right", "rear_left", "rear_right"};
    return names;
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
