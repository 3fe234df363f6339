#pragma once

#include "vectorlib/registration/ScanSurface.h"

#include <algorithm>
#include <array>
#include <vector>

namespace vectorlib {

/// A rotation that two scans may be apart, and how much of their surfaces would then face the same ways.
struct TurnVote {
    int degrees = 0; ///< in [0, 360)
    float votes = 0; ///< only their order has a meaning
};

/// Which rotations bring the surfaces of one scan to face as those of another: the histograms of the
/// normals' directions, correlated for every whole degree. Straight walls make sharp peaks, and round and
/// cluttered places still make some. Keeps its buffers.
class TurnVotes {
public:
    /// The strongest rotations of the moving scan, best first, at most `count`, none within three degrees of
    /// a better one.
    const std::vector<TurnVote> &operator()(const ScanSurface &fixed, const ScanSurface &moving,
                                            std::size_t count) {
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

private:
    static constexpr std::size_t turn = 360; // bins of one degree

    // Each piece is spread over five degrees: so uncertain are normals.
    template <typename Histogram>
    static void fill(const ScanSurface &surface, Histogram &histogram) {
        histogram.fill(0);
        constexpr std::array<float, 5> spread{1, 2, 3, 2, 1};
        for (const SurfacePiece &piece : surface.pieces())
            for (std::size_t k = 0; k < spread.size(); ++k)
                histogram[(static_cast<std::size_t>(piece.direction) + turn + k - 2) % turn] +=
                    spread[k] * piece.length;
    }
    bool isPeak(std::size_t r) const {
        if (!(votes_[r] > 0))
            return false;
        for (std::size_t d = 1; d <= 3; ++d) {
            const float after = votes_[(r + d) % turn], before = votes_[(r + turn - d) % turn];
            if (after > votes_[r] || before >= votes_[r])
                return false;
        }
        return true;
    }

    std::array<float, 2 * turn> fixed_; // twice, one after the other
    std::array<float, turn> moving_, votes_;
    std::vector<TurnVote> peaks_;
};

} // namespace vectorlib
