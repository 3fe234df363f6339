#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"

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

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/OverlapSelection.cpp")
