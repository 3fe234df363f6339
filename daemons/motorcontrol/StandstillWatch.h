#pragma once

#include <QtGlobal>
#include <array>

namespace hermes::motorcontrol {

/// Whether the two motors of a controller are known to stand: it has acknowledged a set-point of zero, and
/// what its encoders told since shows no motion. Counts are modulo 2^32, times seconds of a clock that never
/// jumps.
class StandstillWatch {
public:
    /// counts/s; slower counts as standing.
    void setThreshold(double speed);

    /// It is told to turn, or is not heard any more: nothing is known.
    void doubt();
    /// It has acknowledged a set-point of zero.
    void acknowledged();
    void read(const std::array<quint32, 2> &counts, double time);

    /// So long it takes to see a standstill; seconds.
    double window_s() const { return window_; }
    bool stands() const { return acknowledged_ && still_ && !creeping_; }
    /// What was read last differs from what was read before, by a motion or by creeping for a second.
    bool isMoving() const { return moving_ || creeping_; }
    /// Of the faster motor, by the last two readings; counts/s.
    double speed() const { return speed_; }

private:
    using Counts = std::array<quint32, 2>;

    void watchCreep(bool wasStill, const Counts &counts, double time);

    double threshold_ = 1, window_ = 0.04; // counts/s; seconds in which no more than jitter may be counted
    bool acknowledged_ = false, still_ = false, moving_ = false, creeping_ = false;
    Counts base_{}, last_{};
    double baseTime_ = 0, lastTime_ = 0; // 0: none
    Counts creepBase_{};
    double creepTime_ = 0; // since it is still
    double speed_ = 0;
};

} // namespace hermes::motorcontrol
