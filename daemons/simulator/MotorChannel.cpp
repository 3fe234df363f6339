#include "daemons/simulator/MotorChannel.h"

namespace hermes::simulator {

namespace {

constexpr double controlPeriod = 1.0 / 300; // seconds: the controller measures speed 300 times a second
constexpr double integralRate = 100;
constexpr double approach = 10; // 1/s: the last bit of the way to a position
constexpr double arrived = 1;   // count
constexpr int underflow = 1, overflow = 4;
constexpr double standing = 0.004; // of the full speed; below it friction holds a motor that is not driven

} // namespace

void MotorChannel::take(Mode mode, double target, double slope) {
    if (mode != mode_) { // the ramp goes on from what the motor does now
        setpoint_ = mode == Mode::Speed ? measuredSpeed() : duty_;
        integral_ = lastError_ = 0;
    }
    mode_ = mode;
    target_ = target;
    slope_ = slope;
}

void MotorChannel::driveDuty(double duty, double slope) {
    moves_.clear();
    moving_ = false;
    take(Mode::Duty, std::clamp(duty, -1.0, 1.0), slope);
}

bool MotorChannel::addMove(const Move &move, bool now) {
    if (now)
        moves_.clear();
    if (moves_.size() >= longestQueue)
        return false;
    moves_.push_back(move);
    if (now || !moving_)
        beginMove();
    return true;
}

void MotorChannel::beginMove() {
    move_ = moves_.front();
    moves_.pop_front();
    moving_ = true;
    moveLeft_ = move_.distance;
    take(Mode::Speed, std::clamp(move_.speed, -pid_.qpps, pid_.qpps), move_.acceleration);
    if (move_.position)
        steerToPosition();
}

void MotorChannel::followMove(double travelled) {
    if (!moving_)
        return;
    moveLeft_ -= std::abs(travelled);
    if (move_.position ? std::abs(*move_.position - count_) >= arrived : moveLeft_ > 0)
        return;
    if (!moves_.empty())
        return beginMove();
    moving_ = false;
    take(Mode::Speed, 0, slope_);
}

void MotorChannel::steerToPosition() {
    const double left = *move_.position - count_;
    const double braking = std::sqrt(2 * move_.deceleration * std::abs(left));
    const double fastest = std::min(std::abs(move_.speed), pid_.qpps);
    target_ = std::copysign(std::min({fastest, braking, approach * std::abs(left)}), left);
    const bool slows = std::abs(target_) < std::abs(setpoint_);
    slope_ = slows ? 2 * move_.deceleration : move_.acceleration; // what brakes is the way that is left
}

void MotorChannel::advance(double seconds, double voltage, bool powered) {
    if (!(seconds > 0))
        return;
    if (moving_ && move_.position)
        steerToPosition();
    ramp(seconds);
    controlDue_ += seconds;
    while (controlDue_ >= controlPeriod) {
        controlDue_ -= controlPeriod;
        control();
    }
    if (mode_ == Mode::Duty)
        duty_ = setpoint_;
    turn(seconds, voltage, powered);
}

void MotorChannel::control() {
    if (mode_ != Mode::Speed)
        return;
    const double error = setpoint_ - measuredSpeed();
    integral_ += pid_.i * integralRate * error * controlPeriod;
    integral_ =
        isDriven() ? std::clamp(integral_, -pid_.qpps, pid_.qpps) : 0; // it would push beyond standing
    const double wanted = setpoint_ + pid_.p * error + integral_ + pid_.d * (error - lastError_);
    lastError_ = error;
    duty_ = pid_.qpps > 0 ? std::clamp(wanted / pid_.qpps, -1.0, 1.0) : 0;
    if (!isDriven() && std::abs(measuredSpeed()) < standing * motor_.fullSpeed)
        duty_ = 0;
}

void MotorChannel::turn(double seconds, double voltage, bool powered) {
    const double drive = powered ? duty_ * voltage / motor_.nominal : speed_ / motor_.fullSpeed;
    double excess = drive - speed_ / motor_.fullSpeed; // what accelerates, as a share of the stall current
    limited_ = std::abs(excess) * motor_.stallCurrent > currentLimit_;
    if (limited_)
        excess = std::copysign(currentLimit_ / motor_.stallCurrent, excess);
    if (!powered)
        excess = -0.1 * speed_ / motor_.fullSpeed; // bearings
    const double before = speed_;
    speed_ += motor_.fullSpeed * excess * (1 - std::exp(-seconds / motor_.lag));
    if (blocked_ || (!isDriven() && std::abs(speed_) < standing * motor_.fullSpeed))
        speed_ = 0;
    current_ =
        powered ? excess * motor_.stallCurrent + (speed_ != 0 ? std::copysign(motor_.idleCurrent, duty_) : 0)
                : 0;
    const double travelled = (before + speed_) / 2 * seconds;
    if (!encoderBroken_)
        countOn(encoderBackward_ ? -travelled : travelled);
    followMove(travelled);
}

void MotorChannel::countOn(double counts) {
    const auto round = [this] { return count() >> 32; }; // how often the counter has gone round
    const std::int64_t before = round();
    count_ += counts;
    wraps_ |= round() < before ? underflow : round() > before ? overflow : 0;
}

} // namespace hermes::simulator
