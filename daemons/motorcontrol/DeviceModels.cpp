#include "daemons/motorcontrol/DeviceModels.h"

#include "protocol/drive/ArduinoDevice.h"
#include "protocol/drive/OpenCrDevice.h"
#include "protocol/drive/RoboteqDevice.h"
#include "protocol/drive/VescDevice.h"
#include "protocol/roboclaw/Device.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>

namespace hermes::motorcontrol {

const std::vector<DeviceModel> &deviceModels() {
    using namespace drive;
    using Device = std::unique_ptr<MotorDevice>;
    static const std::vector<DeviceModel> models{
        {"roboclaw",
         "a RoboClaw",
         "RoboClaws",
         115200,
         controllerCount,
         {0.1, roboclaw::Device::longestTimeout_s, true, false},
         {roboclaw::firstAddress, roboclaw::lastAddress, "0x%1", 16, true},
         {true, true, true, true},
         [](const DeviceSettings &) { return 0.0; },
         [](int address) -> Device { return std::make_unique<roboclaw::Device>(std::uint8_t(address)); }},
        {"arduino",
         "an Arduino",
         "an Arduino (ros_arduino_bridge)",
         ArduinoDevice::usualBaud,
         1,
         {ArduinoDevice::timeout_s, ArduinoDevice::timeout_s, false, false},
         {},
         {false, false, false, false},
         [](const DeviceSettings &) { return ArduinoDevice::framesPerSecond; },
         [](int) -> Device { return std::make_unique<ArduinoDevice>(); }},
        {"vesc",
         "a VESC",
         "pairs of VESCs",
         VescDevice::usualBaud,
         controllerCount,
         {0.1, VescDevice::longestTimeout_s, false, true},
         {0, VescDevice::alone, "CAN id %1", 10, false, VescDevice::alone},
         {true, true, true, true},
         [](const DeviceSettings &s) { return s.leastErpm / VescDevice::erpmPerCount; },
         [](int address) -> Device { return std::make_unique<VescDevice>(address); },
         true},
        {"opencr",
         "an OpenCR",
         "an OpenCR (TurtleBot 3)",
         OpenCrDevice::usualBaud,
         1,
         {OpenCrDevice::timeout_s, OpenCrDevice::timeout_s, false, false},
         {},
         {true, false, false, false},
         [](const DeviceSettings &s) {
             return s.countsPerTurn / (2 * vectorlib::pi * s.wheelRadius_m * OpenCrDevice::stepsPerMetre);
         },
         [](int) -> Device { return std::make_unique<OpenCrDevice>(); }},
        {"roboteq",
         "a Roboteq",
         "Roboteqs",
         RoboteqDevice::usualBaud,
         controllerCount,
         {0.1, RoboteqDevice::longestTimeout_s, true, false},
         {},
         {true, true, false, false},
         [](const DeviceSettings &s) { return s.pid.qpps / RoboteqDevice::fullSpeed; },
         [](int) -> Device { return std::make_unique<RoboteqDevice>(); }},
    };
    return models;
}

const DeviceModel &deviceModel(std::string_view name) {
    const auto &models = deviceModels();
    const auto named =
        std::find_if(models.begin(), models.end(), [&](const DeviceModel &m) { return m.name == name; });
    return named == models.end() ? models.front() : *named;
}

} // namespace hermes::motorcontrol
