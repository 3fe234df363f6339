#pragma once

#include "vectorlib/correspondence/OverlapSelection.h"
#include "vectorlib/similarity/NelderMeadFitter.h"
#include "vectorlib/similarity/QuadrangleCriterion.h"

namespace vectorlib {

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
                                      const Transformation2D &expected) {
        // In the expected sensor frame, as elsewhere (erratum 13).
        const Transformation2D toLocal = expected.inverse();
        fixed_.clear();
        for (const LineSegment2D<double> &segment : fixed)
            fixed_.push_back(toLocal * segment);
        match_.pairs = select(fixed_, moving);
        match_.accepted = areSkew();
        criterion_.clear();
        for (const CorrespondencePair &pair : match_.pairs)
            criterion_.add({fixedOf(pair), moving[static_cast<std::size_t>(pair.moving)], 1});
        const Transformation2D found =
            match_.accepted ? fit(criterion_, Transformation2D()) : Transformation2D();
        match_.criterion = criterion_(found);
        match_.pose = expected * found;
        return match_;
    }

private:
    const LineSegment2D<double> &fixedOf(const CorrespondencePair &pair) const {
        return fixed_[static_cast<std::size_t>(pair.fixed)];
    }
    Vector2D<double> directionOf(std::size_t pair) const { return fixedOf(match_.pairs[pair]).direction(); }
    bool areSkew() const {
        const double sine = std::sin(skew);
        for (std::size_t i = 0; i < match_.pairs.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (std::abs(directionOf(i).cross(directionOf(j))) >= sine)
                    return true;
        return false;
    }

    OverlapSelection::Segments fixed_;
    QuadrangleCriterion criterion_;
    QuadrangleMatch match_;
};

} // namespace vectorlib
