#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/ScanSurface.h"

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
                                            std::size_t count);

private:
    static constexpr std::size_t turn = 360; // bins of one degree

    // Each piece is spread over five degrees: so uncertain are normals.
    template <typename Histogram>
    static void fill(const ScanSurface &surface, Histogram &histogram);
    bool isPeak(std::size_t r) const;

    std::array<float, 2 * turn> fixed_; // twice, one after the other
    std::array<float, turn> moving_, votes_;
    std::vector<TurnVote> peaks_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/TurnVotes.cpp")
