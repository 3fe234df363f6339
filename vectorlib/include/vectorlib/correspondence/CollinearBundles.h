#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/correspondence/PotentialPairs.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <cstdint>
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
    double energyOf(const PotentialPair &p, const Bundle &bundle) const {
        const double turn = wrapAngle(p.alpha - bundle.alpha);
        const double apart = side(p, bundle) * p.shift - bundle.shift;
        return stiffness.alpha * turn * turn + stiffness.xy * apart * apart;
    }
    // Facing walls share a direction, not a normal.
    static double side(const PotentialPair &p, const Bundle &bundle) {
        return p.normal.dot(bundle.normal) < 0 ? -1 : 1;
    }
    void join(Bundle &bundle, int number);

    const std::vector<PotentialPair> *pairs_ = nullptr;
    std::vector<Bundle> bundles_;
    std::vector<int> next_; // of every pair, in its bundle
};

/// Sorts bundles into buckets: bundles of one bucket have nearly parallel lines, so that any two of them
/// collide and at most one can be part of a solution. Thesis 7.4.1, figure 7.18. The buckets and the bundles
/// in each come longest first. Keeps its buffers.
class BundleBuckets {
public:
    double reliability = 0.10; ///< sine of the largest angle between lines of one bucket

    /// `bundles` must stay as they are while the buckets are in use.
    void operator()(const std::vector<Bundle> &bundles);

    std::size_t size() const { return leaders_.size(); }
    /// The bundles of a bucket are number begin(bucket) to begin(bucket + 1), longest first.
    std::size_t begin(std::size_t bucket) const { return starts_[bucket]; }
    /// The bundle of a number; see begin().
    const Bundle &bundle(std::size_t number) const { return *order_[number].bundle; }
    /// The most length that this bucket and those after it can give; metres.
    double remaining(std::size_t bucket) const { return remaining_[bucket]; }

private:
    struct Entry {
        const Bundle *bundle;
        std::size_t bucket;

        bool operator<(const Entry &o) const {
            return bucket != o.bucket                   ? bucket < o.bucket
                   : bundle->length != o.bundle->length ? bundle->length > o.bundle->length
                                                        : bundle < o.bundle;
        }
    };
    std::vector<Entry> order_;            // by bucket
    std::vector<const Bundle *> leaders_; // the longest of every bucket
    std::vector<std::size_t> starts_;
    std::vector<double> remaining_;
};

/// A combination of bundles of several directions, which determines a transformation.
struct Combination {
    Transformation2D transformation;
    double length = 0; ///< of its bundles; metres
};

/// Which transformations count as one.
struct SamePose {
    double distance = 0.10; ///< metres
    double angle = 0.05;    ///< radians

    /// Whether both transformations are one: nearer to each other than `distance` and `angle`.
    bool operator()(const Transformation2D &a, const Transformation2D &b) const {
        return (a.translation() - b.translation()).norm() < distance &&
               std::abs(wrapAngle(a.alpha() - b.alpha())) < angle;
    }
};

/// Combines bundles, at most one of each bucket, and keeps the longest combinations. Thesis 7.4.1, last
/// stage.
///
/// Energy (7.44) only grows as bundles join, so that a branch ends with the first bundle that adds more of it
/// than `ambiguity` for a unit of weight. It also ends where even the longest bundles of all buckets to come
/// cannot make it longer than the combinations that are kept.
class BundleCombinations {
public:
    double reliability = 0.10;  ///< least of a combination
    double ambiguity = 0.0025;  ///< most energy of a bundle; m^2
    std::size_t keep = 16;      ///< combinations; at least 1
    std::uint64_t most = 20000; ///< bundles tried; then the search ends with what it has
    SamePose same;

    /// The combinations, longest first; valid until the next call.
    const std::vector<Combination> &operator()(const BundleBuckets &buckets);
    /// How many bundles were tried.
    std::uint64_t tried() const { return tried_; }
    /// Whether `most` ended the search before its end.
    bool isCut() const { return cut_; }

private:
    bool isTooShort(double length) const { return kept_.size() >= keep && length <= kept_.back().length; }

    // Extends the combination chosen_[bucket], of `count` bundles, by the buckets from `bucket` on.
    void extend(std::size_t bucket, std::size_t count, double length);
    void conclude(double length);

    const BundleBuckets *buckets_ = nullptr;
    std::vector<LineSegmentRegistration> chosen_; // the combination before every bucket
    std::vector<Combination> kept_;
    std::uint64_t tried_ = 0;
    bool cut_ = false;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/CollinearBundles.cpp")
