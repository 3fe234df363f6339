#include "daemons/simulator/MotorKinds.h"

namespace hermes::simulator {

namespace {

template <typename Emulator>
std::unique_ptr<MotorEmulator> made(const typename Emulator::Options &options) {
    return std::make_unique<Emulator>(options);
}

} // namespace

const std::vector<MotorKind> &motorKinds() {
    using Options = const MotorOptions &;
    using Number = std::size_t;
    using Faults = std::vector<const char *>;
    const Faults ofRoboClaw{"silence",       "loss",     "corrupt",        "slow",
                            "deaf",          "mute",     "latched",        "echo",
                            "stuck_timeout", "brownout", "emergency_stop", "over_temperature",
                            "over_current",  "driver"};
    const Faults ofArduino{"silence", "loss", "corrupt", "slow", "deaf", "mute", "stuck_timeout", "restart"};
    const Faults ofOthers{"silence", "loss",    "corrupt",       "slow",    "deaf",
                          "mute",    "latched", "stuck_timeout", "brownout"};
    static const std::vector<MotorKind> kinds{
        {"roboclaw", "two RoboClaws", 2, 0, true, ofRoboClaw,
         [](Options o, Number number) { return made<RoboClawEmulator>(o.controller[number]); }},
        {"arduino", "an Arduino", 1, ArduinoEmulator::baud, false, ofArduino,
         [](Options o, Number) { return made<ArduinoEmulator>(o.arduino); }},
        {"vesc", "two VESCs", 1, VescEmulator::baud, true, ofOthers,
         [](Options o, Number) { return made<VescEmulator>(o.vesc); }},
        {"opencr", "an OpenCR", 1, 0, true, ofOthers,
         [](Options o, Number) { return made<OpenCrEmulator>(o.openCr); }},
        {"roboteq", "a Roboteq", 1, RoboteqEmulator::baud, false, ofOthers,
         [](Options o, Number) { return made<RoboteqEmulator>(o.roboteq); }}};
    return kinds;
}

const MotorKind &motorKind(const std::string &name) {
    for (const MotorKind &kind : motorKinds()) {
        if (kind.name == name)
            return kind;
    }
    return motorKinds().front();
}

} // namespace hermes::simulator
