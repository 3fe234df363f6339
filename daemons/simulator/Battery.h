#pragma once

#include <algorithm>

namespace hermes::simulator {

/// A battery whose voltage falls as it is emptied, and under load: evenly at first, and with the last of the
/// charge it collapses. By default two lead-acid batteries in series (thesis 4.1.2).
class Battery {
public:
    struct Options {
        double full = 25.4;  ///< V, without load
        double empty = 23.4; ///< V, without load, before it collapses
        double capacity_Ah = 26;
        double resistance = 0.02; ///< ohm
    };

    Battery() = default;
    explicit Battery(const Options &options)
        : options_(options) {}

    /// 1 is full, 0 empty.
    void setCharge(double share) { charge_ = std::clamp(share, 0.0, 1.0); }
    double charge() const { return charge_; }
    void draw(double amperes, double seconds) {
        current_ = amperes;
        setCharge(charge_ - amperes * seconds / 3600 / options_.capacity_Ah);
    }
    double voltage() const {
        const double resting = options_.empty + (options_.full - options_.empty) * charge_;
        const double collapsed =
            std::max(0.0, options_.empty - exhausted) * std::max(0.0, 1 - charge_ / last);
        return std::max(0.0, resting - collapsed - current_ * options_.resistance);
    }

private:
    static constexpr double last = 0.05;    // of the charge
    static constexpr double exhausted = 20; // V, without load and charge

    Options options_;
    double charge_ = 1;
    double current_ = 0;
};

} // namespace hermes::simulator
