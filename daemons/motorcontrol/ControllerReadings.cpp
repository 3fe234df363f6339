#include "daemons/motorcontrol/ControllerReadings.h"

#include "protocol/roboclaw/Status.h"

#include <algorithm>

namespace hermes::motorcontrol {

using roboclaw::Command;

namespace {

// Full duty is 32767; a controller that tells -32768 means the same.
double dutyOf(std::int64_t pwm) {
    return std::clamp(double(pwm) / 32767, -1.0, 1.0);
}

} // namespace

void ControllerReadings::takeSlow(int slow, const roboclaw::Bus::Outcome &outcome) {
    const roboclaw::Reply &reply = outcome.reply;
    switch (slowCommand(slow)) {
    case Command::ReadStatus:
        status = roboclaw::statusOf(reply, outcome.dialect);
        break;
    case Command::ReadCurrents:
        current_a = {double(reply[0]) / 100, double(reply[1]) / 100};
        break;
    case Command::ReadPwm:
        duty = {dutyOf(reply[0]), dutyOf(reply[1])};
        break;
    case Command::ReadMainBattery:
        battery_v = double(reply[0]) / 10;
        break;
    case Command::ReadTemperature:
        temperature_c = double(reply[0]) / 10;
        break;
    case Command::ReadLogicBattery:
        logic_v = double(reply[0]) / 10;
        break;
    default:
        timeoutTenths = reply[0];
        break;
    }
    complete = complete || slow == slowCount - 1;
}

} // namespace hermes::motorcontrol
