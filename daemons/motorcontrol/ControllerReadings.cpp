#include "daemons/motorcontrol/ControllerReadings.h"

#include "protocol/roboclaw/Status.h"

namespace hermes::motorcontrol {

using roboclaw::Command;

constexpr double fullDuty = 32767;

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
        duty = {double(reply[0]) / fullDuty, double(reply[1]) / fullDuty};
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
