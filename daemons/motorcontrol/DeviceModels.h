#pragma once

#include "protocol/drive/MotorDevice.h"

#include <memory>
#include <string_view>
#include <vector>

namespace hermes::motorcontrol {

constexpr int controllerCount = 4; ///< of a robot, at most

/// A kind of motor controller: a base is a row of the table of them.
struct DeviceModel {
    /// After which it stops by itself: what controllers.timeout_s may promise, in seconds.
    struct Timeout {
        double soonest_s, latest_s;
        bool isSet;     ///< by Hermes, and read back; else the device's own is what is told
        bool mayBeNone; ///< it may have none
    };
    /// Of controllers.N.address.
    struct Address {
        int first = 0, last = 255;
        const char *text = nullptr; ///< for people; nullptr: it has none
        int base = 10;              ///< in which people write it
        bool sharesLine = false;    ///< several with different ones may be on one line
        int alone = -1;             ///< at this one it has no second motor
    };
    /// Whether it tells of battery, currents, temperature, and the duties of its motors.
    using Measures = std::array<bool, 4>;

    const char *name;  ///< as in controllers.kind
    const char *title; ///< "a RoboClaw"
    const char *about; ///< for who chooses
    int baud;          ///< the usual one
    int most;          ///< on a robot
    Timeout timeout;
    Address address;
    Measures measures;
    /// Slower than this (counts/s) it cannot turn its wheels.
    double (*slowest)(const drive::DeviceSettings &settings);
    std::unique_ptr<drive::MotorDevice> (*make)(int address);
    bool turnsServo = false; ///< it has an output for that of a steered axle
};

/// The first one is the usual one.
const std::vector<DeviceModel> &deviceModels();
/// The usual one where there is none of this name.
const DeviceModel &deviceModel(std::string_view name);

} // namespace hermes::motorcontrol
