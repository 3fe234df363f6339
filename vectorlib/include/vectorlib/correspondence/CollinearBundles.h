#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/correspondence/PotentialPair.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <vector>

namespace vectorlib {

/// Pairs with nearly parallel static lines whose transformations agree: none collides with another, and
/// together they leave only the shift along the lines open.
struct Bundle {
    Vector2D<double> normal; ///< of its first, longest pair
    double shift = 0;        ///< mean along the normal; metres
    double alpha = 0;        ///< mean; radians
    double length = 0;       ///< of the dynamic segments in it, each counted once; metres
    LineSegmentRegistration sums;
    int first = -1; ///< the pair added last; the others follow in CollinearBundles::next
};

/// Sorts potential pairs into unambiguous collinear bundles. Thesis 7.4.1.
///
/// A pair joins a bundle where the reliability of the two directions is at most the threshold and where the
/// energy (7.44) that the pair adds, for a unit of its weight, is at most the ambiguity threshold; else it
/// founds a bundle. The published rule bounds the sum over a bundle: that lets one bad pair into a small
/// bundle and keeps good pairs out of a large one. Long pairs come first, so that the most precise lead.
class CollinearBundles {
public:
    double reliability = 0.10; ///< sine of the largest angle between lines of one bundle
    double ambiguity = 0.0025; ///< most energy of a pair; m^2
    Stiffness stiffness;

    /// The bundles; reorders the pairs. Valid until the next call.
    const std::vector<Bundle> &operator()(std::vector<PotentialPair> &pairs);
    /// The pair that follows in its bundle, or -1.
    int next(int pair) const { return next_[static_cast<std::size_t>(pair)]; }

private:
    static bool before(const CorrespondencePair &a, const CorrespondencePair &b) {
        return a.moving != b.moving ? a.moving < b.moving : a.fixed < b.fixed;
    }
    const PotentialPair &pair(int i) const { return (*pairs_)[static_cast<std::size_t>(i)]; }

    void place(int number);
    double energyOf(const PotentialPair &p, const Bundle &bundle) const;
    // Facing walls share a direction, not a normal.
    static double side(const PotentialPair &p, const Bundle &bundle) {
        return p.normal.dot(bundle.normal) < 0 ? -1 : 1;
    }
    void join(Bundle &bundle, int number);

    const std::vector<PotentialPair> *pairs_ = nullptr;
    std::vector<Bundle> bundles_;
    std::vector<int> next_; // of every pair, in its bundle
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/CollinearBundles.cpp")
