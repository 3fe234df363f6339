#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/similarity/NelderMeadFitter.h"

#include <vector>

namespace vectorlib {

/// Settings of OverlapSelection.
struct OverlapSettings {
    double minLength = 0.5;   ///< shorter edges of either set take no part; metres
    double maxAngle = 0.40;   ///< largest error of the expected heading; radians
    double maxDistance = 0.5; ///< largest error of the expected position; metres
};

/// Pairs edges of a scan with those of a map as overview paper 2.2 did. Two edges may be one when the angle
/// between their lines is small enough and one end of the new edge lies near enough to the other edge. An
/// edge with one such partner takes it; those with several then choose the nearest of the partners that are
/// left. Keeps its buffers between calls.
class OverlapSelection {
public:
    using Segments = std::vector<LineSegment2D<double>>;

    OverlapSettings settings;

    /// Both in the frame of the expected pose. Valid until the next call.
    const std::vector<CorrespondencePair> &operator()(const Segments &fixed, const Segments &moving);

    /// The three groups of the last call: long new edges without a partner, with one, and with several.
    std::size_t alone() const { return alone_; }
    std::size_t sure() const { return sure_; }
    std::size_t ambiguous() const { return open_.size(); }

private:
    bool isLong(const LineSegment2D<double> &s) const { return s.length() >= settings.minLength; }
    void take(std::size_t f, std::size_t m);
    // How many partners an edge may have; the nearest one is left in nearest_.
    int partnersOf(const Segments &fixed, const LineSegment2D<double> &moving, bool onlyFree = false);

    std::vector<CorrespondencePair> pairs_;
    std::vector<std::size_t> open_; // moving edges of the third group
    std::vector<char> isTaken_;     // fixed edges of the second group
    std::size_t nearest_ = 0, alone_ = 0, sure_ = 0;
};

/// What QuadrangleMatcher found.
struct QuadrangleMatch {
    Transformation2D pose; ///< moves the dynamic set onto the static one; the expected one where not accepted
    std::vector<CorrespondencePair> pairs;
    double criterion = 0;  ///< at the pose; m^4
    bool accepted = false; ///< any two pairs are skew: else a direction is open
};

/// The matcher of overview paper 2.2 as a whole, kept as a baseline: OverlapSelection, then the least sum of
/// squared quadrangles by Nelder-Mead. Only long edges fit; short ones may decorate a map. Keeps its buffers
/// between calls.
class QuadrangleMatcher {
public:
    OverlapSelection select;
    NelderMeadFitter fit;
    double skew = 0.17; ///< least angle between the lines of two pairs that are skew; radians

    QuadrangleMatcher() { fit.tolerance = 1e-6; }

    /// `fixed` in the map's frame, `moving` in the sensor's; `expected` moves the second onto the first.
    /// Valid until the next call.
    const QuadrangleMatch &operator()(const OverlapSelection::Segments &fixed,
                                      const OverlapSelection::Segments &moving,
                                      const Transformation2D &expected);

private:
    const LineSegment2D<double> &fixedOf(const CorrespondencePair &pair) const {
        return fixed_[static_cast<std::size_t>(pair.fixed)];
    }
    Vector2D<double> directionOf(std::size_t pair) const { return fixedOf(match_.pairs[pair]).direction(); }
    bool areSkew() const;

    OverlapSelection::Segments fixed_;
    QuadrangleCriterion criterion_;
    QuadrangleMatch match_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/QuadrangleMatcher.cpp")
