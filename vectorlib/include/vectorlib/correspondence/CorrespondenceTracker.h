#pragma once

#include "vectorlib/correspondence/Match.h"
#include "vectorlib/correspondence/PotentialPairs.h"
#include "vectorlib/correspondence/RotationVotes.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/SmallMatrix.h"
#include "vectorlib/registration/LineSegmentRegistration.h"
#include "vectorlib/registration/PointToLineRefinement.h"

#include <vector>

namespace vectorlib {

/// Settings of CorrespondenceTracker: which pairs it takes, and how far it trusts the expected pose.
struct TrackingSettings {
    PermittedError permitted = {0.5, 0.5, 0.4}; ///< of the expected pose
    double finalDistance =
        0.10;                 ///< root mean square distance from the line beyond which a pair is none; metres
    double finalAngle = 0.17; ///< the same for the angle between the segments; radians
    double minOverlap = 0.2;  ///< share of the shorter segment that must lie over the other
    /// How far the expected pose may be wrong, a standard deviation; decides where the lines leave a
    /// direction open. Metres.
    double expectedDeviationXY = 0.05;
    double expectedDeviationAlpha = 0.10; ///< the same of its heading; radians
    /// Standard deviation of one point from its static line, the line's own error included; weighs points
    /// against the expected pose. Metres.
    double pointDeviation = 0.15;
    std::size_t minPairs = 2;       ///< fewer pairs are no match
    double minMatchedShare = 0.15;  ///< of the length of all dynamic edges; with less there is no match
    int rotations = 3;              ///< how many likely rotations are tried beside the expected one
    int iterations = 12;            ///< most refinement steps for each
    double gateFactor = 0.6;        ///< how fast the gates narrow from the permitted error to the final ones
    double expectationScore = 0.05; ///< metres of matched length that one squared standard deviation costs

    /// For an expected pose that is hardly more than a guess: scans far apart, without odometry.
    static TrackingSettings forPoorExpectation() {
        TrackingSettings s;
        s.permitted = {2, 2, 1.26};
        s.expectedDeviationXY = 1;
        s.expectedDeviationAlpha = 0.5;
        s.minMatchedShare = 0.3;
        return s;
    }
};

/// Finds which edges of a scan correspond to which of the map, tracking from an expected pose.
///
/// Potential pairs come from the permitted set of transformations (thesis 7.4.1). From the expected pose, and
/// from the rotations that most pairs ask for, every dynamic edge takes its nearest potential partner while
/// the gate narrows; the pose follows from the points of all pairs by their sums. The start that explains the
/// most length wins. Reliability and ambiguity are those of the one-step registration of its pairs. Keeps its
/// buffers between calls.
class CorrespondenceTracker {
public:
    TrackingSettings settings;

    /// `fixed` in the map's frame, `moving` in the sensor's; `expected` moves the second onto the first.
    const Match &operator()(const std::vector<LineSegment2D<double>> &fixed,
                            const std::vector<EdgeRaw2D> &moving, const Transformation2D &expected) {
        // Everything happens in the expected sensor frame, where segments are near the origin (erratum 13).
        const Transformation2D toLocal = expected.inverse();
        fixed_.clear();
        for (const LineSegment2D<double> &segment : fixed)
            fixed_.push_back(toLocal * segment);
        moving_ = &moving;
        collectCandidates();

        Transformation2D best = track(Transformation2D());
        double bestScore = score(best);
        bestPairs_ = pairs_;
        for (double alpha : votes_.peaks(settings.rotations)) {
            const Transformation2D other = track(Transformation2D(0, 0, alpha));
            const double otherScore = score(other);
            if (otherScore > bestScore) {
                bestScore = otherScore;
                best = other;
                bestPairs_ = pairs_;
            }
        }
        conclude(expected, best);
        return match_;
    }

private:
    const LineSegment2D<double> &fixedOf(const CorrespondencePair &p) const {
        return fixed_[static_cast<std::size_t>(p.fixed)];
    }
    const EdgeRaw2D &movingOf(const CorrespondencePair &p) const {
        return (*moving_)[static_cast<std::size_t>(p.moving)];
    }
    static double angleBetween(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving) {
        return std::atan2(moving.direction().cross(fixed.direction()),
                          moving.direction().dot(fixed.direction()));
    }

    void collectCandidates() {
        candidates_.clear();
        votes_.start(settings.permitted.dalpha);
        const double cosine = std::cos(std::min(pi, settings.permitted.dalpha)) - 1e-9;
        for (std::size_t d = 0; d < moving_->size(); ++d)
            for (std::size_t s = 0; s < fixed_.size(); ++s) {
                const LineSegment2D<double> &moving = (*moving_)[d].segment, &fixed = fixed_[s];
                if (fixed.direction().dot(moving.direction()) < cosine || // most end here
                    !mayCorrespond(fixed, moving, settings.permitted))
                    continue;
                candidates_.push_back({static_cast<int>(s), static_cast<int>(d)});
                votes_.add(angleBetween(fixed, moving), std::min(fixed.length(), moving.length()));
            }
    }
    // Follows the nearest pairs from a start to where they agree; leaves the final pairs in pairs_.
    Transformation2D track(Transformation2D correction) {
        double gate = std::max(settings.permitted.dx, settings.permitted.dy),
               angle = settings.permitted.dalpha;
        for (int i = 0; i < settings.iterations; ++i) {
            choosePairs(correction, gate, angle);
            const Transformation2D step = refine(correction);
            correction = step * correction;
            const bool narrow = gate <= settings.finalDistance && angle <= settings.finalAngle;
            if (narrow && step.translation().norm() < 1e-5 && std::abs(step.sin()) < 1e-6)
                break;
            gate = std::max(settings.finalDistance, gate * settings.gateFactor);
            angle = std::max(settings.finalAngle, angle * settings.gateFactor);
        }
        choosePairs(correction, settings.finalDistance, settings.finalAngle);
        return correction;
    }
    // For every dynamic edge its nearest potential partner within the gates.
    void choosePairs(const Transformation2D &correction, double gate, double angle) {
        pairs_.clear();
        const double cosine = std::cos(angle);
        int current = -1;
        double nearest = 0;
        LineSegment2D<double> moved;
        for (const CorrespondencePair &c : candidates_) { // sorted by dynamic edge
            if (c.moving != current) {
                current = c.moving;
                moved = correction * movingOf(c).segment;
                nearest = gate * gate;
            }
            const LineSegment2D<double> &fixed = fixedOf(c);
            if (fixed.direction().dot(moved.direction()) < cosine)
                continue;
            const double distance = fixed.meanSquareAcross(moved);
            if (distance > nearest ||
                fixed.overlap(moved) < settings.minOverlap * std::min(fixed.length(), moved.length()))
                continue;
            nearest = distance;
            if (!pairs_.empty() && pairs_.back().moving == c.moving)
                pairs_.back().fixed = c.fixed;
            else
                pairs_.push_back(c);
        }
    }
    Transformation2D refine(const Transformation2D &correction) {
        const double xy = settings.pointDeviation / settings.expectedDeviationXY;
        const double alpha = settings.pointDeviation / settings.expectedDeviationAlpha;
        refinement_.start(xy * xy, alpha * alpha);
        for (const CorrespondencePair &p : pairs_)
            refinement_.add(fixedOf(p), correction * movingOf(p).sums, 1.0);
        return refinement_.step();
    }
    // Matched length, less the more the pairs lie apart and the farther the pose is from the expected one.
    double score(const Transformation2D &correction) const {
        double sum = 0;
        for (const CorrespondencePair &p : pairs_) {
            const LineSegment2D<double> moved = correction * movingOf(p).segment;
            const double distance = fixedOf(p).meanSquareAcross(moved);
            sum += fixedOf(p).overlap(moved) *
                   (1 - distance / (settings.finalDistance * settings.finalDistance));
        }
        const double xy = correction.translation().norm() / settings.expectedDeviationXY;
        const double alpha = correction.alpha() / settings.expectedDeviationAlpha;
        return sum - settings.expectationScore * (xy * xy + alpha * alpha);
    }
    void conclude(const Transformation2D &expected, const Transformation2D &correction) {
        Match &m = match_;
        m.pose = expected * correction;
        m.pairs = bestPairs_;
        m.matchedLength = m.visibleLength = 0;
        for (const EdgeRaw2D &edge : *moving_)
            m.visibleLength += edge.segment.length();
        registration_.clear();
        refinement_.start(0, 0);
        double squares = 0, points = 0;
        for (const CorrespondencePair &p : m.pairs) {
            const LineSegment2D<double> &fixed = fixedOf(p), &moving = movingOf(p).segment;
            m.matchedLength += moving.length();
            registration_.add(fixed, moving, std::min(fixed.length(), moving.length()));
            const EdgeRaw2D moved = correction * movingOf(p);
            squares += moved.sums.n * fixed.meanSquareAcross(moved.segment);
            points += moved.sums.n;
            refinement_.add(fixed, moved.sums, 1 / (settings.pointDeviation * settings.pointDeviation));
        }
        m.rms = points > 0 ? std::sqrt(squares / points) : 0;
        m.reliability = registration_.reliability();
        m.ambiguity = registration_.ambiguity(correction).total();
        m.accepted = m.pairs.size() >= settings.minPairs &&
                     m.matchedLength >= settings.minMatchedShare * m.visibleLength &&
                     std::abs(correction.x()) <= settings.permitted.dx &&
                     std::abs(correction.y()) <= settings.permitted.dy &&
                     std::abs(correction.alpha()) <= settings.permitted.dalpha;
        Eigen::Matrix3d toMap = Eigen::Matrix3d::Identity();
        toMap.topLeftCorner<2, 2>() << expected.cos(), -expected.sin(), expected.sin(), expected.cos();
        m.information = product(toMap, refinement_.information(), toMap);
    }

    std::vector<LineSegment2D<double>> fixed_; // in the expected sensor frame
    const std::vector<EdgeRaw2D> *moving_ = nullptr;
    std::vector<CorrespondencePair> candidates_; // sorted by moving edge
    std::vector<CorrespondencePair> pairs_;
    std::vector<CorrespondencePair> bestPairs_;
    RotationVotes votes_;
    LineSegmentRegistration registration_;
    PointToLineRefinement refinement_;
    Match match_;
};

} // namespace vectorlib
