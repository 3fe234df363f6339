#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/PotentialPair.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <vector>

namespace vectorlib {

/// Pairs with nearly parallel lines that agree on the rotation and on the shift across the lines; together
/// they leave the shift along them open.
struct PublishedBundle {
    LineSegmentRegistration sums;
    std::vector<int> pairs; ///< numbers of potential pairs
    std::size_t bucket = 0;
    Vector2D<double> normal;        ///< of its first pair
    double alpha = 0;               ///< of its first pair; radians
    double turns = 0, turns2 = 0;   ///< weighted sums of rotations beside that, and of their squares
    double shifts = 0, shifts2 = 0; ///< the same of shifts along the normal

    explicit PublishedBundle(const PotentialPair &first);
    /// Takes a pair into the sums, not into `pairs`.
    void add(const PotentialPair &pair);
    double length() const { return sums.weight(); } ///< of the shorter segments of its pairs; metres
    /// The sum (7.44) over the pairs where the lines are parallel: of rotation and of shift across; m^2.
    double ambiguity() const;
};

/// Bundles and buckets by the rules as published, thesis 7.4.1; CollinearBundles and BundleBuckets, which
/// CorrespondenceFinder uses, mend them. A pair joins the first bundle that with it keeps both thresholds,
/// else it founds one. A bundle lies in the first bucket whose bundles it leaves unreliable, each of them.
///
/// Where the text leaves it open: pairs come by static, then dynamic segment; a pair weighs as many as its
/// shorter segment has metres (registration paper 4); and since a bundle can be shifted along its lines, its
/// ambiguity is that across them. At the optimum (7.26) lines that are nearly parallel meet far away, where
/// they cross: an ambiguity of 0, whatever lies between them. For reports and comparisons: allocates.
class PublishedBundles {
public:
    double reliability = 0.10; ///< most of a bundle
    double ambiguity = 0.0025; ///< most of a bundle; m^2

    /// Sorts pairs into bundles, and the bundles into buckets(). The bundles are in the order in which they
    /// were founded; valid until the next call.
    const std::vector<PublishedBundle> &operator()(const std::vector<PotentialPair> &pairs);
    const std::vector<PublishedBundle> &bundles() const { return bundles_; }
    /// The numbers of the bundles of each bucket.
    const std::vector<std::vector<std::size_t>> &buckets() const { return buckets_; }

private:
    void place(const PotentialPair &pair, int number);
    bool collide(std::size_t a, std::size_t b) const;
    void putIntoBucket(std::size_t bundle);

    std::vector<PublishedBundle> bundles_;
    std::vector<std::vector<std::size_t>> buckets_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/PublishedBundles.cpp")
