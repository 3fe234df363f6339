#pragma once

#include <optional>

namespace hermes::motorcontrol {

/// Judges a measured value by two thresholds. It counts as a fault when it is beyond that threshold for a
/// while, without a break: a peak is none. A value that is not finite counts as beyond.
class Threshold {
public:
    enum class Side { Above, Below }; ///< where it is bad
    enum class Level { Good, Warning, Fault };
    struct Settings {
        double warning = 0;
        double fault = 0;
        double hold_s = 1;
    };

    explicit Threshold(Side side)
        : side_(side) {}

    void set(const Settings &settings) { settings_ = settings; }
    const Settings &settings() const { return settings_; }

    /// now: seconds of a clock that never jumps.
    Level judge(double value, double now) {
        if (!isBeyond(value, settings_.fault)) {
            since_.reset();
            return isBeyond(value, settings_.warning) ? Level::Warning : Level::Good;
        }
        if (!since_)
            since_ = now;
        return now - *since_ >= settings_.hold_s ? Level::Fault : Level::Warning;
    }

private:
    bool isBeyond(double value, double limit) const {
        return side_ == Side::Above ? !(value <= limit) : !(value >= limit);
    }

    Side side_;
    Settings settings_;
    std::optional<double> since_;
};

} // namespace hermes::motorcontrol
