#include "daemons/simulator/RoboClawEmulator.h"

namespace hermes::simulator {

using namespace roboclaw;

// How the emulator obeys commands that turn motors.

bool RoboClawEmulator::turnsMotors(Command command) {
    const int number = int(command);
    return number <= 1 || (number >= 4 && number <= 13) || (number >= 32 && number <= 46) ||
           (number >= 50 && number <= 54) || (number >= 65 && number <= 67);
}

bool RoboClawEmulator::drive(const Request &request) {
    const Values &v = request.values;
    auto &[m1, m2] = channels_;
    const auto duty = [&](std::size_t i) { return double(v[i]) / fullDuty; };
    const auto share = [&] { return double(v[0]) / 127; };
    const auto around64 = [&] { return double(v[0] - 64) / (v[0] < 64 ? 64 : 63); };
    const auto speed = [&](std::size_t i) { return double(v[i]); };
    switch (request.command) {
    case Command::ForwardM1:
        return m1.driveDuty(share()), true;
    case Command::BackwardM1:
        return m1.driveDuty(-share()), true;
    case Command::ForwardM2:
        return m2.driveDuty(share()), true;
    case Command::BackwardM2:
        return m2.driveDuty(-share()), true;
    case Command::DriveM1:
        return m1.driveDuty(around64()), true;
    case Command::DriveM2:
        return m2.driveDuty(around64()), true;
    case Command::DutyM1:
        return m1.driveDuty(duty(0)), true;
    case Command::DutyM2:
        return m2.driveDuty(duty(0)), true;
    case Command::Duty:
        return m1.driveDuty(duty(0)), m2.driveDuty(duty(1)), true;
    case Command::DutyAccelM1:
        return m1.driveDuty(duty(0), duty(1)), true;
    case Command::DutyAccelM2:
        return m2.driveDuty(duty(0), duty(1)), true;
    case Command::DutyAccel:
        return m1.driveDuty(duty(0), duty(1)), m2.driveDuty(duty(2), duty(3)), true;
    case Command::SpeedM1:
        return m1.driveSpeed(speed(0)), true;
    case Command::SpeedM2:
        return m2.driveSpeed(speed(0)), true;
    case Command::Speed:
        return m1.driveSpeed(speed(0)), m2.driveSpeed(speed(1)), true;
    case Command::SpeedAccelM1:
        return m1.driveSpeed(speed(1), speed(0)), true;
    case Command::SpeedAccelM2:
        return m2.driveSpeed(speed(1), speed(0)), true;
    case Command::SpeedAccel:
        return m1.driveSpeed(speed(1), speed(0)), m2.driveSpeed(speed(2), speed(0)), true;
    case Command::SpeedAccel2:
        return m1.driveSpeed(speed(1), speed(0)), m2.driveSpeed(speed(3), speed(2)), true;
    default:
        return false;
    }
}

bool RoboClawEmulator::driveDistance(const Request &request) {
    const Values &v = request.values;
    const auto move = [&](int motor, std::size_t speed, double acceleration) {
        const MotorChannel::Move stretch{double(v[speed]), acceleration, double(v[speed + 1])};
        channel(motor).addMove(stretch, v[v.size() - 1] == 1);
    };
    switch (request.command) {
    case Command::SpeedDistanceM1:
        return move(0, 0, MotorChannel::atOnce), true;
    case Command::SpeedDistanceM2:
        return move(1, 0, MotorChannel::atOnce), true;
    case Command::SpeedDistance:
        return move(0, 0, MotorChannel::atOnce), move(1, 2, MotorChannel::atOnce), true;
    case Command::SpeedAccelDistanceM1:
        return move(0, 1, double(v[0])), true;
    case Command::SpeedAccelDistanceM2:
        return move(1, 1, double(v[0])), true;
    case Command::SpeedAccelDistance:
        return move(0, 1, double(v[0])), move(1, 3, double(v[0])), true;
    case Command::SpeedAccelDistance2:
        return move(0, 1, double(v[0])), move(1, 4, double(v[3])), true;
    default:
        return false;
    }
}

bool RoboClawEmulator::drivePosition(const Request &request) {
    const Values &v = request.values;
    const auto move = [&](int motor, std::size_t first) {
        const MotorChannel::Move way{double(v[first + 1]), double(v[first]), 0, double(v[first + 2]),
                                     double(std::int32_t(v[first + 3]))};
        channel(motor).addMove(way, v[v.size() - 1] == 1);
    };
    switch (request.command) {
    case Command::PositionM1:
        return move(0, 0), true;
    case Command::PositionM2:
        return move(1, 0), true;
    case Command::Position:
        return move(0, 0), move(1, 4), true;
    default:
        return false;
    }
}

bool RoboClawEmulator::driveMixed(const Request &request) {
    const double value = double(request.values.size() == 0 ? 0 : request.values[0]);
    const double share = value / 127, around64 = (value - 64) / (value < 64 ? 64 : 63);
    switch (request.command) {
    case Command::MixedForward:
        mixedDrive_ = share;
        break;
    case Command::MixedBackward:
        mixedDrive_ = -share;
        break;
    case Command::MixedRight:
        mixedTurn_ = share;
        break;
    case Command::MixedLeft:
        mixedTurn_ = -share;
        break;
    case Command::MixedDrive:
        mixedDrive_ = around64;
        break;
    case Command::MixedTurn:
        mixedTurn_ = around64;
        break;
    default:
        return false;
    }
    if (mixedDrive_ && mixedTurn_) { // the first motor is on the left
        channels_[0].driveDuty(*mixedDrive_ + *mixedTurn_);
        channels_[1].driveDuty(*mixedDrive_ - *mixedTurn_);
    }
    return true;
}

} // namespace hermes::simulator
