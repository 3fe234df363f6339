#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/BundleBuckets.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <cstdint>
#include <vector>

namespace vectorlib {

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
    bool operator()(const Transformation2D &a, const Transformation2D &b) const;
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

#include VECTORLIB_BODIES("vectorlib/src/correspondence/BundleCombinations.cpp")
