#pragma once

#include "gui/vector/MatchOutcome.h"
#include "gui/vector/SegmentSet.h"
#include "vectorlib/correspondence/CorrespondenceFinder.h"

#include <optional>
#include <string>
#include <vector>

namespace hermes::vector {

/// A motion that was found, and what is known of it.
struct MatchedSolution {
    /// Its score is up to 1, whatever the method; docs/hermes-vector.md tells how each makes it.
    vectorlib::Solution solution;
    std::string verdict;               ///< "accepted", or why not
    std::optional<double> probability; ///< where the method tells one
    std::optional<Eigen::Matrix3d> covariance;
};

/// What one of the methods makes of two sets.
struct Matched {
    std::string method;
    MatchOutcome outcome = MatchOutcome::Nowhere;
    std::string reason; ///< of any outcome but Found
    std::size_t potentialPairs = 0;
    std::uint64_t combinations = 0;
    std::vector<MatchedSolution> solutions; ///< best first

    /// The outcome in words, for people.
    std::string text() const {
        return outcome == MatchOutcome::Found ? describe(outcome) : describe(outcome) + (": " + reason);
    }
};

/// Where the second set is expected in the frame of the first; standard deviations in metres and radians.
struct MatchExpectation {
    vectorlib::Transformation2D pose;
    double deviationXY = 0.15, deviationAlpha = 0.10;
};

/// The correspondence search over a permitted set of motions.
Matched matchByFinder(const SegmentSet &fixed, const SegmentSet &moving,
                      const vectorlib::SearchSettings &settings, const vectorlib::Transformation2D &around,
                      bool inMap);
/// From nothing but the two sets. Segments are matched as a scanner would see them, and then exactly.
/// noise: standard deviation of points for the covariance, metres; 0: as they scatter.
Matched matchGlobally(const SegmentSet &fixed, const SegmentSet &moving, double noise);
/// From nothing but the two sets, by relations of their segments. Ends of segments that come without points
/// may go on unseen.
Matched matchByRelations(const SegmentSet &fixed, const SegmentSet &moving);
/// From an estimate, two sets of points.
Matched matchTracking(const SegmentSet &fixed, const SegmentSet &moving, const MatchExpectation &expected,
                      const vectorlib::EarSettings &segmentation, double noise);

} // namespace hermes::vector
