#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

namespace hermes::simulator {

/// One channel of a motor controller with its motor and encoder: duty or velocity control with a ramp, and a
/// motor that follows with a lag. Speeds are in counts/s. Time comes from outside.
class MotorChannel {
public:
    static constexpr double unlimited = std::numeric_limits<double>::infinity();
    static constexpr double atOnce = unlimited; ///< as a slope
    static constexpr std::size_t longestQueue = 64;

    struct Motor {
        double fullSpeed = 160000; ///< counts/s at full duty and nominal voltage
        double nominal = 24;       ///< V
        double lag = 0.02;         ///< time constant of the speed; seconds
        double stallCurrent = 30;  ///< A at full duty and nominal voltage, standing
        double idleCurrent = 0.5;  ///< A while turning without load
    };
    /// Of the velocity control, as command 28 sets it. The units of the gains are not published: here P is
    /// duty for an error of QPPS, I adds 100 I of it each second, D acts on the change in 1/300 s.
    struct Pid {
        double p = 1, i = 0.5, d = 0.25;
        double qpps = 44000; ///< counts/s that the control takes for full duty
    };
    /// A stretch at a speed, or the way to a position.
    struct Move {
        double speed; ///< signed; to a position its amount counts
        double acceleration;
        double distance;                               ///< counts, not negative
        double deceleration = atOnce;                  ///< before a position
        std::optional<double> position = std::nullopt; ///< counts; instead of a distance
    };
    MotorChannel() = default;
    explicit MotorChannel(const Motor &motor)
        : motor_(motor) {}

    void setPid(const Pid &pid) { pid_ = pid; }
    const Pid &pid() const { return pid_; }

    /// duty: -1 to 1; slope: change a second.
    void driveDuty(double duty, double slope = atOnce);
    /// Limited to QPPS. acceleration: counts/s^2.
    void driveSpeed(double speed, double acceleration = atOnce) {
        moves_.clear();
        moving_ = false;
        take(Mode::Speed, std::clamp(speed, -pid_.qpps, pid_.qpps), acceleration);
    }
    /// Queues a stretch; with now it begins at once and drops what is queued. False when the queue is full.
    bool addMove(const Move &move, bool now);
    /// Duty 0 at once.
    void stop() { driveDuty(0); }

    void setCount(std::int64_t count) { count_ = double(count); }
    /// The shaft is held.
    void setBlocked(bool blocked) { blocked_ = blocked; }
    /// The encoder's cable is off: counts and measured speed stand still.
    void setEncoderBroken(bool broken) { encoderBroken_ = broken; }
    /// The encoder's two signals are exchanged: it counts backward, and the velocity control pushes the wrong
    /// way.
    void setEncoderBackward(bool backward) { encoderBackward_ = backward; }
    /// The counter leaps, the wheel does not.
    void jump(std::int64_t counts) { countOn(double(counts)); }
    void setCurrentLimit(double amperes) { currentLimit_ = amperes; }

    /// voltage: of the battery; powered: false while the bridge is off and the motor rolls freely.
    void advance(double seconds, double voltage, bool powered);

    double target() const { return target_; } ///< as last asked: duty or counts/s
    double speed() const { return speed_; }   ///< of the shaft
    /// As the encoder tells it.
    double measuredSpeed() const { return encoderBroken_ ? 0 : encoderBackward_ ? -speed_ : speed_; }
    std::int64_t count() const { return std::int64_t(std::floor(count_)); }
    /// Since it was asked last the counter of 32 bits ran below 0 (1), over its end (4), both (5).
    int takeWraps() { return std::exchange(wraps_, 0); }
    double duty() const { return duty_; }
    /// A; signed as the torque: against the duty while it feeds back.
    double current() const { return current_; }
    bool isLimited() const { return limited_; } ///< by the limit of the current
    bool isDriven() const { return mode_ == Mode::Speed ? setpoint_ != 0 || target_ != 0 : target_ != 0; }
    /// As command 47: stretches that wait; 0 while the last one runs, 0x80 when there is none.
    int queueLength() const { return moving_ ? int(moves_.size()) : 0x80; }

private:
    enum class Mode { Duty, Speed };

    void take(Mode mode, double target, double slope);
    void beginMove();
    void followMove(double travelled);
    void steerToPosition();
    void ramp(double seconds) {
        const double change = slope_ * seconds; // infinite: at once
        setpoint_ += std::clamp(target_ - setpoint_, -change, change);
    }
    void control();
    void turn(double seconds, double voltage, bool powered);
    void countOn(double counts);

    Motor motor_;
    Pid pid_;
    Mode mode_ = Mode::Duty;
    double target_ = 0;   ///< duty or counts/s
    double setpoint_ = 0; ///< on its way to target
    double slope_ = atOnce;
    std::deque<Move> moves_;
    Move move_{}; ///< while moving_
    double moveLeft_ = 0;
    bool moving_ = false;
    double integral_ = 0;
    double lastError_ = 0;
    double controlDue_ = 0; ///< seconds
    double duty_ = 0;
    double speed_ = 0;
    double count_ = 0;
    double current_ = 0;
    double currentLimit_ = unlimited;
    bool limited_ = false;
    bool blocked_ = false;
    bool encoderBroken_ = false;
    bool encoderBackward_ = false;
    int wraps_ = 0; // as takeWraps() tells them
};

} // namespace hermes::simulator
