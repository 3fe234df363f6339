#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace hermes::motorcontrol {

/// How often a controller is read, by its last ten readings. Below the least rate until it is a tenth above
/// it again. Times are seconds of a clock that never jumps.
class ReadingRate {
public:
    explicit ReadingRate(double least)
        : least_(least) {}

    void restart() { size_ = 0; }
    void add(double time) {
        times_[next_] = time;
        next_ = (next_ + 1) % times_.size();
        size_ = size_ < times_.size() ? size_ + 1 : size_;
        if (const auto rate = perSecond())
            below_ = *rate < (below_ ? 1.1 : 1) * least_;
    }
    std::optional<double> perSecond() const {
        if (size_ < times_.size())
            return std::nullopt;
        const double newest = times_[(next_ + times_.size() - 1) % times_.size()];
        return newest > times_[next_] ? double(times_.size() - 1) / (newest - times_[next_])
                                      : std::optional<double>();
    }
    bool isBelow() const { return below_; }

private:
    double least_;
    bool below_ = false;
    std::array<double, 11> times_{};
    std::size_t next_ = 0, size_ = 0;
};

} // namespace hermes::motorcontrol
