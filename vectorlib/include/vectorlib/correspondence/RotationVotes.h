#pragma once

#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// A histogram of the rotations that pairs of segments ask for; its peaks are the rotations worth trying.
class RotationVotes {
public:
    /// Begins anew for rotations of at most `limit`; radians.
    void start(double limit) {
        half_ = static_cast<int>(limit / bin) + 2;
        votes_.assign(static_cast<std::size_t>(2 * half_ + 1), 0.0);
    }
    /// A pair asks for a rotation (radians); one beyond the limit is left out.
    void add(double alpha, double weight) {
        const int i = static_cast<int>(std::lround(alpha / bin)) + half_;
        if (i > 0 && i + 1 < static_cast<int>(votes_.size())) {
            votes_[static_cast<std::size_t>(i - 1)] += weight;
            votes_[static_cast<std::size_t>(i)] += 2 * weight;
            votes_[static_cast<std::size_t>(i + 1)] += weight;
        }
    }
    /// The strongest rotations, best first, at most `count` and none next to a better one; radians.
    const std::vector<double> &peaks(int count) {
        peaks_.clear();
        for (int k = 0; k < count; ++k) {
            const auto top = std::max_element(votes_.begin(), votes_.end());
            if (top == votes_.end() || *top <= 0)
                break;
            const auto i = top - votes_.begin(), last = static_cast<std::ptrdiff_t>(votes_.size()) - 1;
            peaks_.push_back(static_cast<double>(i - half_) * bin);
            for (auto j = std::max<std::ptrdiff_t>(0, i - 2); j <= std::min(last, i + 2); ++j)
                votes_[static_cast<std::size_t>(j)] = 0;
        }
        return peaks_;
    }

private:
    static constexpr double bin = pi / 90; // 2 degrees
    int half_ = 0;
    std::vector<double> votes_;
    std::vector<double> peaks_;
};

} // namespace vectorlib
