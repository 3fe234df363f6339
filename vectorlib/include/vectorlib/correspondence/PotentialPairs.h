#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/observation/Discrepancy.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vectorlib {

/// A pair that may correspond, and the line of its perfect transformations: rotation alpha, and shift along
/// the static segment's normal. Thesis (7.19).
struct PotentialPair {
    CorrespondencePair numbers;
    Vector2D<double> normal; ///< of the static segment, towards free space
    double shift = 0;        ///< metres
    double alpha = 0;        ///< radians
    double length = 0;       ///< of the shorter segment, the pair's weight; metres
    LineSegmentRegistration sums;

    PotentialPair(CorrespondencePair pair, const LineSegment2D<double> &fixed,
                  const LineSegment2D<double> &moving, const Stiffness &stiffness)
        : numbers(pair)
        , normal(fixed.normal())
        , shift(fixed.begin().dot(normal) - moving.begin().dot(moving.normal())) // erratum 6
        , alpha(std::atan2(moving.direction().cross(fixed.direction()),
                           moving.direction().dot(fixed.direction())))
        , length(std::min(fixed.length(), moving.length())) {
        sums.stiffness = stiffness;
        sums.add(fixed, moving, length);
    }
};

/// The permitted set of transformations around the expected one; metres and radians. Defaults of the thesis
/// appendices.
struct PermittedError {
    double dx = 1.2;
    double dy = 1.2;
    double dalpha = 1.26;

    /// Whether a transformation is in the set, whose centre is the identity.
    bool holds(const Transformation2D &t) const {
        return std::abs(t.x()) <= dx && std::abs(t.y()) <= dy && std::abs(t.alpha()) <= dalpha;
    }
};

/// Whether some transformation of the permitted set, centred at the identity, brings `moving` onto the line
/// of `fixed` so that they share at least one point. Thesis 7.4.1 with (7.19): the perfect transformations of
/// the pair form a line P + tau v in the space of translations; it is clipped by the box |x| <= dx, |y| <= dy
/// and by the overlap, exactly.
bool mayCorrespond(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving,
                   const PermittedError &permitted);

/// Defaults: the published experiments (thesis appendices).
struct SearchSettings {
    PermittedError permitted;
    double reliability = 0.10; ///< least of a solution; also what tells directions apart
    double ambiguity = 0.0025; ///< most energy of a pair; m^2
    Stiffness stiffness;
    double discrepancy = 0.2; ///< most of an accepted solution; m^2
    /// Or this share of the area that both views see: outlines that are seen a ray sooner or later differ by
    /// areas that grow with the place.
    double discrepancyShare = 0.03;
    double sharedView = 0.25;   ///< least share of the seen angle that the expected view must show
    double matchedShare = 0.30; ///< least share of the dynamic length that must have partners
    std::size_t maxSolutions = 16;
    std::size_t maxPairs = 5000;           ///< potential pairs
    std::size_t maxCompared = 50000000;    ///< pairs of segments that are near each other, half a second
    std::uint64_t maxCombinations = 20000; ///< bundles tried

    bool isGood() const {
        for (double value :
             {permitted.dx, permitted.dy, permitted.dalpha, reliability, ambiguity, stiffness.alpha,
              stiffness.xy, discrepancy, discrepancyShare, sharedView, matchedShare})
            if (!(value >= 0) || !std::isfinite(value))
                return false;
        return maxSolutions > 0 && maxPairs > 0 && maxCompared > 0 && maxCombinations > 0;
    }
    /// Whether an expected view shows enough of what was seen under `observedAngle` to tell anything.
    bool isEvidence(const ViewComparison &view, double observedAngle) const {
        return view.angle > 0 && view.angle >= sharedView * observedAngle;
    }
};

/// Segments by the line they lie on and by their place along it, both seen from the origin. Rotated about the
/// origin a segment keeps both, so that whatever a rotation and a short shift bring onto a line is found by
/// them, without looking at all others. Keeps its buffers.
class NearLines {
public:
    /// Takes finite segments of some length, in a frame whose origin is the centre of rotation. `reach`: the
    /// longest shift; metres.
    void build(const std::vector<LineSegment2D<double>> &segments, double reach) {
        reach_ = std::min(reach, 1e12) + rounding;
        longest_ = 0;
        entries_.clear();
        for (const LineSegment2D<double> &s : segments) {
            entries_.push_back({rowOf(across(s)), along(s), static_cast<int>(entries_.size())});
            longest_ = std::max(longest_, s.length());
        }
        std::sort(entries_.begin(), entries_.end());
    }
    /// Calls take(number) for every segment that a rotation about the origin and then a shift of at most
    /// `reach` bring onto the line of `s` and beside it, and for some more; ends where it returns false.
    template <typename Take>
    void query(const LineSegment2D<double> &s, Take take) const {
        const double from = along(s) - reach_ - longest_, to = along(s) + s.length() + reach_;
        const std::int64_t last = rowOf(across(s) + reach_);
        for (std::int64_t row = rowOf(across(s) - reach_); row <= last; ++row) {
            auto e = std::lower_bound(entries_.begin(), entries_.end(), Entry{row, from, -1});
            for (; e != entries_.end() && e->row == row && e->along <= to; ++e)
                if (!take(e->number))
                    return;
        }
    }

private:
    static constexpr double rounding = 1e-6; // of products of coordinates up to 10^9 m; metres

    struct Entry {
        std::int64_t row;
        double along; // where it begins; metres
        int number;

        bool operator<(const Entry &o) const {
            return row != o.row ? row < o.row : along != o.along ? along < o.along : number < o.number;
        }
    };

    static double across(const LineSegment2D<double> &s) { return s.begin().dot(s.normal()); }
    static double along(const LineSegment2D<double> &s) { return s.begin().dot(s.direction()); }
    // Rows are as high as the reach, so that a query looks at three or four.
    std::int64_t rowOf(double across) const {
        return static_cast<std::int64_t>(std::clamp(std::floor(across / reach_), -1e15, 1e15));
    }

    double reach_ = 1, longest_ = 0;
    std::vector<Entry> entries_;
};

/// Collects all pairs that may correspond (thesis 7.4.1, first stage) without looking at what is far apart.
/// Keeps its buffers.
class PairCollector {
public:
    using Segments = std::vector<LineSegment2D<double>>;

    /// Both sets in the expected sensor frame, finite and of some length. False where `maxPairs` or
    /// `maxCompared` of the settings ended it.
    bool operator()(const Segments &fixed, const Segments &moving, const SearchSettings &settings,
                    std::vector<PotentialPair> &pairs);

private:
    NearLines lines_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/PotentialPairs.cpp")
