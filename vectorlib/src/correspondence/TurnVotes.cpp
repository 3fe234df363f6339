#include "vectorlib/correspondence/TurnVotes.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY const std::vector<TurnVote> &
TurnVotes::operator()(const ScanSurface &fixed, const ScanSurface &moving, std::size_t count) {
    fill(fixed, fixed_);
    fill(moving, moving_);
    std::copy_n(fixed_.begin(), turn, fixed_.begin() + turn);
    votes_.fill(0);
    for (std::size_t i = 0; i < turn; ++i)
        if (const float weight = moving_[i]; weight > 0)
            for (std::size_t r = 0; r < turn; ++r)
                votes_[r] += weight * fixed_[i + r];
    peaks_.clear();
    for (std::size_t r = 0; r < turn; ++r)
        if (isPeak(r))
            peaks_.push_back({static_cast<int>(r), votes_[r]});
    std::sort(peaks_.begin(), peaks_.end(), [](const TurnVote &a, const TurnVote &b) {
        return a.votes != b.votes ? a.votes > b.votes : a.degrees < b.degrees;
    });
    if (peaks_.size() > count)
        peaks_.resize(count);
    return peaks_;
}

template <typename Histogram>
void TurnVotes::fill(const ScanSurface &surface, Histogram &histogram) {
    histogram.fill(0);
    constexpr std::array<float, 5> spread{1, 2, 3, 2, 1};
    for (const SurfacePiece &piece : surface.pieces())
        for (std::size_t k = 0; k < spread.size(); ++k)
            histogram[(static_cast<std::size_t>(piece.direction) + turn + k - 2) % turn] +=
                spread[k] * piece.length;
}

VECTORLIB_BODY bool TurnVotes::isPeak(std::size_t r) const {
    if (!(votes_[r] > 0))
        return false;
    for (std::size_t d = 1; d <= 3; ++d) {
        const float after = votes_[(r + d) % turn], before = votes_[(r + turn - d) % turn];
        if (after > votes_[r] || before >= votes_[r])
            return false;
    }
    return true;
}

} // namespace vectorlib
