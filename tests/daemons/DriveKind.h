#pragma once

#include "daemons/motorcontrol/MotorSettings.h"
#include "daemons/simulator/Drivetrain.h"

/// A kind of drive: the same robot for the motor control and for the simulator.
struct DriveKind {
    using Base = hermes::simulator::WheelBase;
    static constexpr hermes::motorcontrol::WheelGeometry geometry{0.1, 0.25, 0.2, 0.3, 0.9};

    QString layout;
    int rearMotors;
    Base::Kind simulated;

    static const std::map<QString, DriveKind> &all() {
        using K = Base::Kind;
        static const std::map<QString, DriveKind> kinds{
            {"mecanum", {"mecanum", 1, K::Mecanum}},
            {"differential", {"differential", 1, K::Differential}},
            {"two_wheels", {"two_wheels", 1, K::TwoWheels}},
            {"omni3", {"omni3", 1, K::Omni3}},
            {"omni4", {"omni4", 1, K::Omni4}},
            {"ackermann", {"ackermann", 1, K::Ackermann}},
            {"ackermann, two motors", {"ackermann", 2, K::Ackermann}}};
        return kinds;
    }
    static const DriveKind &of(const QString &name) { return all().at(name); }

    bool steers() const { return simulated == Base::Kind::Ackermann; }
    hermes::motorcontrol::WheelLayout wheels() const { return settings()->drive.layout; }
    Base base() const {
        return {simulated,           geometry.radius,    geometry.halfBase, geometry.halfTrack,
                geometry.omniRadius, geometry.omniAngle, rearMotors};
    }
    hermes::simulator::Drivetrain::Options drivetrain() const {
        hermes::simulator::Drivetrain::Options options;
        options.base = base();
        if (steers()) {
            options.kind = "vesc";
        }
        return options;
    }
    /// more: groups that replace those of the kind.
    hermes::Result<hermes::motorcontrol::MotorSettings> settings(const QJsonObject &more = {}) const {
        QJsonObject all{{"frame", QJsonObject{{"layout", layout},
                                              {"wheel_radius_m", geometry.radius},
                                              {"half_base_m", geometry.halfBase},
                                              {"half_track_m", geometry.halfTrack},
                                              {"omni_radius_m", geometry.omniRadius},
                                              {"omni_angle_rad", geometry.omniAngle},
                                              {"rear_motors", rearMotors}}}};
        if (steers()) { // a VESC turns the servo
            all["controllers"] = QJsonObject{
                {"kind", "vesc"},
                {"timeout_s", 1},
                {"1", QJsonObject{{"address", hermes::simulator::VescEmulator::Options().ids[1]}}}};
            all["wheels"] = QJsonObject{{"rear_left", QJsonObject{{"controller", 1}}},
                                        {"rear_right", QJsonObject{{"controller", 1}}}};
        }
        for (auto group = more.begin(); group != more.end(); ++group)
            all[group.key()] = group.value();
        hermes::Settings settings;
        hermes::motorcontrol::declareMotorSettings(settings);
        settings.addRule(hermes::motorcontrol::checkMotorSettings);
        const auto set = settings.set(all);
        if (!set)
            return set.error();
        return hermes::motorcontrol::MotorSettings::from(settings);
    }
};
