#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"
#include "vectorlib/registration/PointRefinement.h"
#include "vectorlib/relations/MatchingTable.h"
#include "vectorlib/relations/TypedSegment.h"
#include "vectorlib/tls/TlsSums.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <vector>

namespace vectorlib {

/// The pairs of a matching table, best first. Algorithm 5: the pair of the largest merged score sets the
/// rotation, the others must have the same within the window; what is matched makes the rest of its row and
/// column invalid (Algorithm 7), or all that is not in its order (Algorithm 10). Keeps its buffers.
class PairSearch {
public:
    double threshold = 0;                    ///< merged scores must be above it
    double window = 5 * pi / 180;            ///< of rotations; radians
    bool sameOrder = false;                  ///< Algorithm 10 instead of 7
    static constexpr int maxSteps = 1 << 14; ///< pairs looked at, matched or not

    /// rotation(row, column) is the angle that turns the current segment onto the reference one. What was
    /// matched stays in the table, its rivals are gone. fixed is a row, moving a column.
    template <typename RotationOf>
    const std::vector<CorrespondencePair> &operator()(MatchingTable &table, RotationOf rotation) {
        pairs_.clear();
        MatchingTable::Cell best = table.maximum();
        const double angle = best.score > 0 ? rotation(best.row, best.column) : 0;
        for (int step = 0; best.score > threshold && step < maxSteps; ++step) {
            if (std::abs(wrapAngle(rotation(best.row, best.column) - angle)) <= window) {
                pairs_.push_back({best.row, best.column});
                table.take(best.row, best.column);
                if (sameOrder)
                    table.keepInOrder(best.row, best.column);
                else
                    table.keepOnly(best.row, best.column);
            } else {
                table.invalidate(best.row, best.column);
            }
            best = table.maximum();
        }
        return pairs_;
    }

private:
    std::vector<CorrespondencePair> pairs_;
};

/// The pairs that agree on one place, and the pose that fits them best. Algorithm 5 asks of its pairs only
/// that they agree on the rotation; a wall taken for a parallel one does that too. Every two pairs that are
/// not parallel tell a pose, and so does every pair with an end that is an edge in both scans; the pose that
/// brings most length together wins. Then all segments that lie on each other at that pose are pairs,
/// whatever their scores: the points of the shorter segment of each come onto the line of the longer, and
/// common ends onto each other. Cubic in the pairs; keeps its buffers.
class PairConsensus {
public:
    using Segments = std::vector<TypedSegment>;

    double distance = 0.10;            ///< of the middle of a segment from the line of its partner; metres
    double angle = 5 * pi / 180;       ///< between the segments of a pair; radians
    double leastAngle = 20 * pi / 180; ///< between the lines that tell a pose; radians
    double overlap = 0.3;              ///< least share of the shorter segment beside its partner
    double noise = 0.015;              ///< standard deviation of a point; metres
    /// Where the lines alone tell the position so well, ends take no part: a jump lies between two beams,
    /// which move with the sensor, so that a small motion would come out too small. Metres.
    double linesSuffice = 0.02;
    int rounds = 3; ///< of refinement and choice of pairs

    /// Finds the places of these pairs; returns how many there are, at most `most` (no more than 8), best
    /// first.
    int propose(const std::vector<CorrespondencePair> &pairs, const Segments &reference,
                const Segments &current, int most);
    /// The pose of a proposal that fits its pairs best; pairs() and the rest are its own then.
    Transformation2D settle(int proposal, const Segments &reference, const Segments &current);
    const std::vector<CorrespondencePair> &pairs() const { return chosen_; }
    const LineSegmentRegistration &registration() const { return registration_; }
    /// Standard deviation of the position of the current sensor; metres.
    double deviation() const { return deviation_; }
    double length() const { return length_; } ///< of the shorter segments of the pairs; metres

private:
    struct Proposal {
        Transformation2D pose;
        double length = 0;
    };
    static const TypedSegment &at(const Segments &set, int i) { return set[static_cast<std::size_t>(i)]; }

    // How far apart two segments lie: at the middle of the shorter, whose line may be unsure elsewhere.
    // Metres; more than the limit where they are turned too much.
    double apart(const LineSegment2D<double> &r, const LineSegment2D<double> &c) const {
        if (!(r.direction().dot(c.direction()) >= std::cos(angle)))
            return 2 * distance;
        return std::abs(c.length() < r.length() ? r.across(c.middle()) : c.across(r.middle()));
    }
    void choose(const std::vector<CorrespondencePair> &pairs, const Segments &reference,
                const Segments &current, const Transformation2D &pose);
    // Of all segments, those that lie on each other: each current one with the nearest reference.
    void chooseAll(const Segments &reference, const Segments &current, const Transformation2D &pose);
    // Points of the shorter segment onto the line of the longer.
    Transformation2D refinement(const Segments &reference, const Segments &current,
                                const Transformation2D &pose);
    // A common end holds along the line, as well as both are known.
    void addCommonEnd(const TypedSegment &r, const TypedSegment &c, bool atEnd, const Transformation2D &pose);
    // Of the current sensor, which is at the translation of the pose. The line of the other scan is as unsure
    // as the points.
    double deviationOf(const Transformation2D &pose) const;
    // The line of the points, which may be fewer than those of the segment; the segment where there are none.
    static LineSegment2D<double> lineOf(const TypedSegment &s);
    // Without points, as of 20 spread evenly over each metre.
    static TlsSums sumsOf(const TypedSegment &s);
    // Keeps the proposals of the most length, one of each place.
    void enter(const Proposal &p);
    int addEmpty() {
        proposals_[static_cast<std::size_t>(count_)].length = 0;
        return count_++;
    }
    bool isNear(const Transformation2D &a, const Transformation2D &b) const {
        return (a.translation() - b.translation()).squaredNorm() <= 4 * distance * distance &&
               a.cos() * b.cos() + a.sin() * b.sin() >= std::cos(2 * angle);
    }
    // Whether an end of both is an edge that is known well enough, and where it is.
    bool commonEnd(const TypedSegment &r, const TypedSegment &c, bool atEnd, Vector2D<double> &there,
                   Vector2D<double> &here) const;
    // The pose of one pair with a common end: onto the line across, onto the end along it.
    bool poseByEnd(const TypedSegment &r, const TypedSegment &c, bool atEnd, Transformation2D &pose) const;
    // The pose of two pairs: the middle of each current segment comes onto the line of its partner.
    bool poseOf(const CorrespondencePair &p, const CorrespondencePair &q, const Segments &reference,
                const Segments &current, Transformation2D &pose) const;
    void enterPairs(const Segments &reference, const Segments &current, const Transformation2D &pose);

    std::array<Proposal, 8> proposals_;
    int count_ = 0, most_ = 0;
    std::vector<CorrespondencePair> chosen_;
    double length_ = 0, deviation_ = 0;
    LineSegmentRegistration registration_;
    PointToLineRefinement refine_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/PairConsensus.cpp")
