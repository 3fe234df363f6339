#include "vectorlib/correspondence/RotationVotes.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY void RotationVotes::start(double limit) {
    half_ = static_cast<int>(limit / bin) + 2;
    votes_.assign(static_cast<std::size_t>(2 * half_ + 1), 0.0);
}

VECTORLIB_BODY void RotationVotes::add(double alpha, double weight) {
    const int i = static_cast<int>(std::lround(alpha / bin)) + half_;
    if (i > 0 && i + 1 < static_cast<int>(votes_.size())) {
        votes_[static_cast<std::size_t>(i - 1)] += weight;
        votes_[static_cast<std::size_t>(i)] += 2 * weight;
        votes_[static_cast<std::size_t>(i + 1)] += weight;
    }
}

VECTORLIB_BODY const std::vector<double> &RotationVotes::peaks(int count) {
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

} // namespace vectorlib
