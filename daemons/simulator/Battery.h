#pragma once

#include <algorithm>

namespace hermes::simulator {

/// A battery whose voltage falls as it is emptied, and under load.
class Battery {
public:
    struct Options {
        double full = 25.2; ///< V, without load
        double empty = 20;  ///< V
        double capacity_Ah = 20;
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
        return std::max(0.0, resting - current_ * options_.resistance);
    }

private:
    Options options_;
    double charge_ = 1;
    double current_ = 0;
};

} // namespace hermes::simulator
