#pragma once

#include "daemons/motorcontrol/MotorSettings.h"

/// Of a small robot with an Arduino; more: values that are others.
inline QJsonObject arduinoSettings(const QJsonObject &more = {}) {
    QJsonObject all{{"controllers", QJsonObject{{"kind", "arduino"}, {"timeout_s", 2}}},
                    {"frame", QJsonObject{{"layout", "differential"},
                                          {"wheel_radius_m", 0.033},
                                          {"half_track_m", 0.1},
                                          {"counts_per_turn", 3000}}},
                    {"pid", QJsonObject{{"qpps", 6000}}},
                    {"safety", QJsonObject{{"deceleration", 0.5}}},
                    {"faults", QJsonObject{{"encoder_hold_s", 1.0}}},
                    {"wheels", QJsonObject{{"front_right", QJsonObject{{"reversed", true}}}}},
                    {"motion", QJsonObject{{"vx", 0.3}}}};
    for (auto group = more.begin(); group != more.end(); ++group) {
        QJsonObject values = all[group.key()].toObject();
        const QJsonObject changed = group.value().toObject();
        for (auto value = changed.begin(); value != changed.end(); ++value)
            values[value.key()] = value.value();
        all[group.key()] = values;
    }
    return all;
}

/// Error: what they contradict.
inline hermes::Result<hermes::motorcontrol::MotorSettings> settingsOf(const QJsonObject &json) {
    hermes::Settings settings;
    hermes::motorcontrol::declareMotorSettings(settings);
    settings.addRule(hermes::motorcontrol::checkMotorSettings);
    const auto set = settings.set(json);
    if (!set)
        return set.error();
    return hermes::motorcontrol::MotorSettings::from(settings);
}
