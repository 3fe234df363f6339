#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/ScanSurface.h"

#include <array>
#include <cstdint>
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
    void add(double alpha, double weight);
    /// The strongest rotations, best first, at most `count` and none next to a better one; radians.
    const std::vector<double> &peaks(int count);

private:
    static constexpr double bin = pi / 90; // 2 degrees
    int half_ = 0;
    std::vector<double> votes_;
    std::vector<double> peaks_;
};

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

/// A motion between two scans that many pairs of their pieces ask for.
struct MotionVote {
    Transformation2D pose; ///< of the moving scan in the frame of the fixed one
    float votes = 0;       ///< grows with the length of the surfaces that would come to lie together
};

/// Which translations bring the surfaces of a scan, turned by a given angle, onto those of another: every
/// pair of pieces that face the same way votes for the shift between them. It is an exhaustive correlation,
/// in a square of shifts about zero. Keeps its buffers.
class ShiftVotes {
public:
    float cell = 0.2f;       ///< of the square of shifts, at least; metres
    float tolerance = 15;    ///< most between the normals of pieces that vote; degrees
    std::size_t perTurn = 8; ///< strongest shifts kept for each rotation
    float share = 0.4f;      ///< of the votes of the strongest, with which others are kept

    /// Shifts of more than `reach` metres in x or y are not seen.
    void start(const ScanSurface &fixed, const ScanSurface &moving, float reach);
    /// Adds the strongest shifts after a turn to the list.
    void operator()(int degrees, std::vector<MotionVote> &list) {
        count(degrees);
        smooth();
        collectPeaks(degrees, list);
    }

private:
    static constexpr int cells = 96; // to a side
    static constexpr int block = 16, blocks = cells * cells / block;
    using Counts = std::vector<std::int16_t>;

    void count(int degrees);
    // In decimetres. A pair counts by the product of its lengths, so that sparse and dense points count
    // alike.
    static int weight(const SurfacePiece &piece) { return static_cast<int>(piece.length * 10 + 0.5f); }
    void add(Vector2D<float> at, int votes);
    // Sums over three by three cells, weighted 1 2 1 both ways.
    void smooth();
    void collectPeaks(int degrees, std::vector<MotionVote> &list);
    bool isPeak(int at) const;
    // The top of the parabolas through the cells beside the peak.
    MotionVote voteAt(int at, int degrees) const;

    const std::vector<SurfacePiece> *fixed_ = nullptr, *moving_ = nullptr;
    std::array<std::size_t, 361> begins_{}; // of the fixed pieces, by whole degrees
    float cell_ = 0.2f;
    Counts counts_, rows_, smooth_;
    std::array<std::int16_t, blocks> maxOf_{}; // each sixteen cells
    std::int16_t most_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/Votes.cpp")
