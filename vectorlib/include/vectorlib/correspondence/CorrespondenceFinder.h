#pragma once

#include "vectorlib/correspondence/PotentialPairs.h"
#include "vectorlib/mapping/Edge2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"
#include "vectorlib/registration/PointToLineRefinement.h"

#include <vector>

namespace vectorlib {

struct CorrespondenceSettings {
    PermittedError permitted;
    int iterations = 12; ///< most steps of the refinement
    double finalDistance =
        0.10; ///< pairs farther apart (root mean square) than this at the end are none; metres
    double finalAngle = 0.17; ///< pairs turned by more than this at the end are none; radians
    double minOverlap = 0.3;  ///< share of the shorter segment that must lie over the other
    double expectedDeviationXY =
        0.2; ///< how far the expected pose is trusted where lines leave a direction open; metres
    double expectedDeviationAlpha = 0.2; ///< the same for the heading; radians
    double noise = 0.02;                 ///< standard deviation of a point's distance from its line; metres
    std::size_t minPairs = 2;
    double minMatchedShare = 0.3; ///< of the length of all dynamic edges, to be accepted
};

struct CorrespondencePair {
    int fixed = 0;  ///< index into the static set
    int moving = 0; ///< index into the dynamic set
};

/// A match of a dynamic set (scan) with a static one (map).
struct Match {
    Transformation2D pose; ///< moves the dynamic set onto the static one
    std::vector<CorrespondencePair> pairs;
    double reliability = 0;   ///< in [0, 1], of the pairs' directions
    double ambiguity = 0;     ///< m^2, at the pose
    double matchedLength = 0; ///< of the dynamic edges in pairs; metres
    double visibleLength = 0; ///< of all dynamic edges; metres
    double rms = 0;           ///< of the matched points' distances from their lines; metres
    bool accepted = false;
    Eigen::Matrix3d information =
        Eigen::Matrix3d::Zero(); ///< of (x, y, alpha) in the static frame at the pose, lines only
};

/// Finds which edges of a scan correspond to which of the map, tracking from an expected pose. Potential
/// pairs come from the permitted set of transformations (thesis 7.4.1); from the expected pose on, every
/// dynamic edge takes its nearest potential partner while the gate narrows, and the pose follows from the
/// points of all pairs. Reliability and ambiguity of the final pairs are those of the one-step registration.
/// Keeps its buffers between calls.
class CorrespondenceFinder {
public:
    CorrespondenceSettings settings;

    /// `fixed` in the map's frame, `moving` in the sensor's; `expected` moves the second onto the first.
    const Match &operator()(const std::vector<LineSegment2D<double>> &fixed,
                            const std::vector<EdgeRaw2D> &moving, const Transformation2D &expected) {
        m_match.pairs.clear();
        m_match.visibleLength = 0;
        for (const EdgeRaw2D &edge : moving)
            m_match.visibleLength += edge.segment.length();
        // Everything happens in the expected sensor frame, where segments are near the origin (erratum 13).
        const Transformation2D toLocal = expected.inverse();
        m_fixed.clear();
        for (const auto &segment : fixed)
            m_fixed.push_back(toLocal * segment);
        collectCandidates(moving);

        Transformation2D correction;
        double gate = std::max(settings.permitted.dx, settings.permitted.dy),
               angle = settings.permitted.dalpha;
        for (int i = 0; i < settings.iterations; ++i) {
            gate = std::max(settings.finalDistance, gate * 0.6);
            angle = std::max(settings.finalAngle, angle * 0.6);
            choosePairs(moving, correction, gate, angle);
            const Transformation2D step = refine(moving, correction);
            correction = step * correction;
            const bool narrow = gate <= settings.finalDistance && angle <= settings.finalAngle;
            if (narrow && step.translation().norm() < 1e-5 && std::abs(step.sin()) < 1e-6)
                break;
        }
        choosePairs(moving, correction, settings.finalDistance, settings.finalAngle);
        conclude(moving, expected, correction);
        return m_match;
    }

private:
    struct Candidate {
        int fixed;
        int moving;
    };

    void collectCandidates(const std::vector<EdgeRaw2D> &moving) {
        m_candidates.clear();
        for (std::size_t d = 0; d < moving.size(); ++d)
            for (std::size_t s = 0; s < m_fixed.size(); ++s)
                if (mayCorrespond(m_fixed[s], moving[d].segment, settings.permitted))
                    m_candidates.push_back({static_cast<int>(s), static_cast<int>(d)});
    }
    // Root mean square distance of a segment's points from the line; its ends lie at distances a and b.
    static double meanSquare(double a, double b) { return (a * a + a * b + b * b) / 3; }

    void choosePairs(const std::vector<EdgeRaw2D> &moving, const Transformation2D &correction, double gate,
                     double angle) {
        m_pairs.clear();
        const double cosine = std::cos(angle);
        int current = -1;
        double best = 0;
        LineSegment2D<double> moved;
        for (const Candidate &c : m_candidates) {
            if (c.moving != current) {
                current = c.moving;
                moved = correction * moving[static_cast<std::size_t>(c.moving)].segment;
                best = gate * gate;
            }
            const LineSegment2D<double> &fixed = m_fixed[static_cast<std::size_t>(c.fixed)];
            if (fixed.direction().dot(moved.direction()) < cosine)
                continue;
            const double distance = meanSquare(fixed.across(moved.begin()), fixed.across(moved.end()));
            if (distance > best)
                continue;
            const double shorter = std::min(fixed.length(), moved.length());
            if (fixed.overlap(moved) < settings.minOverlap * shorter)
                continue;
            best = distance;
            if (!m_pairs.empty() && m_pairs.back().moving == c.moving)
                m_pairs.back().fixed = c.fixed;
            else
                m_pairs.push_back({c.fixed, c.moving});
        }
    }
    Transformation2D refine(const std::vector<EdgeRaw2D> &moving, const Transformation2D &correction) {
        const double xy = settings.noise / settings.expectedDeviationXY;
        const double alpha = settings.noise / settings.expectedDeviationAlpha;
        m_refinement.start(xy * xy, alpha * alpha);
        for (const CorrespondencePair &p : m_pairs)
            m_refinement.add(m_fixed[static_cast<std::size_t>(p.fixed)],
                             correction * moving[static_cast<std::size_t>(p.moving)].sums, 1.0);
        return m_refinement.step();
    }
    void conclude(const std::vector<EdgeRaw2D> &moving, const Transformation2D &expected,
                  const Transformation2D &correction) {
        Match &m = m_match;
        m.pose = expected * correction;
        m.pairs = m_pairs;
        m.matchedLength = 0;
        m_registration.clear();
        double squares = 0, points = 0;
        m_refinement.start(0, 0);
        for (const CorrespondencePair &p : m_pairs) {
            const LineSegment2D<double> &fixed = m_fixed[static_cast<std::size_t>(p.fixed)];
            const EdgeRaw2D &edge = moving[static_cast<std::size_t>(p.moving)];
            const EdgeRaw2D moved = correction * edge;
            m.matchedLength += edge.segment.length();
            m_registration.add(fixed, edge.segment, std::min(fixed.length(), edge.segment.length()));
            squares += moved.sums.n *
                       meanSquare(fixed.across(moved.segment.begin()), fixed.across(moved.segment.end()));
            points += moved.sums.n;
            m_refinement.add(fixed, moved.sums, 1 / (settings.noise * settings.noise));
        }
        m.rms = points > 0 ? std::sqrt(squares / points) : 0;
        m.reliability = m_registration.reliability();
        m.ambiguity = m_registration.ambiguity(correction).total();
        m.accepted = m_pairs.size() >= settings.minPairs &&
                     m.matchedLength >= settings.minMatchedShare * m.visibleLength &&
                     std::abs(correction.x()) <= settings.permitted.dx &&
                     std::abs(correction.y()) <= settings.permitted.dy &&
                     std::abs(correction.alpha()) <= settings.permitted.dalpha;
        Eigen::Matrix3d toMap = Eigen::Matrix3d::Identity();
        toMap(0, 0) = toMap(1, 1) = expected.cos();
        toMap(0, 1) = -expected.sin();
        toMap(1, 0) = expected.sin();
        m.information = toMap * m_refinement.information() * toMap.transpose();
    }

    std::vector<LineSegment2D<double>> m_fixed; // in the expected sensor frame
    std::vector<Candidate> m_candidates;        // by moving edge
    std::vector<CorrespondencePair> m_pairs;
    LineSegmentRegistration m_registration;
    PointToLineRefinement m_refinement;
    Match m_match;
};

} // namespace vectorlib
