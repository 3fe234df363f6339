#pragma once

#include "vectorlib/correspondence/BundleBuckets.h"

#include <cstdint>

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
    const std::vector<Combination> &operator()(const BundleBuckets &buckets) {
        buckets_ = &buckets;
        kept_.clear();
        tried_ = 0;
        cut_ = false;
        chosen_.assign(buckets.size() + 1, LineSegmentRegistration());
        extend(0, 0, 0);
        return kept_;
    }
    /// How many bundles were tried.
    std::uint64_t tried() const { return tried_; }
    /// Whether `most` ended the search before its end.
    bool isCut() const { return cut_; }

private:
    bool isTooShort(double length) const { return kept_.size() >= keep && length <= kept_.back().length; }

    // Extends the combination chosen_[bucket], of `count` bundles, by the buckets from `bucket` on.
    void extend(std::size_t bucket, std::size_t count, double length) {
        if (cut_ || isTooShort(length + buckets_->remaining(bucket)))
            return;
        if (bucket == buckets_->size()) {
            if (count > 1)
                conclude(length);
            return;
        }
        const double energy = chosen_[bucket].ambiguity().total();
        for (std::size_t i = buckets_->begin(bucket); i < buckets_->begin(bucket + 1); ++i) {
            const Bundle &next = buckets_->bundle(i);
            if (isTooShort(length + next.length + buckets_->remaining(bucket + 1)))
                break; // the others are shorter
            cut_ = cut_ || tried_ >= most;
            if (cut_)
                return;
            ++tried_;
            LineSegmentRegistration &joint = chosen_[bucket + 1];
            joint = count > 0 ? chosen_[bucket] : next.sums;
            if (count > 0)
                joint.add(next.sums);
            if (count == 0 || joint.ambiguity().total() - energy <= ambiguity * next.sums.weight())
                extend(bucket + 1, count + 1, length + next.length);
        }
        chosen_[bucket + 1] = chosen_[bucket];
        extend(bucket + 1, count, length);
    }
    void conclude(double length) {
        const LineSegmentRegistration &sums = chosen_[buckets_->size()];
        if (sums.reliability() < reliability)
            return;
        const Combination found{sums.transformation(), length};
        const auto known = std::find_if(kept_.begin(), kept_.end(), [&](const Combination &c) {
            return same(c.transformation, found.transformation);
        });
        if (known != kept_.end() && known->length >= length)
            return;
        if (known != kept_.end())
            kept_.erase(known);
        kept_.insert(
            std::upper_bound(kept_.begin(), kept_.end(), found,
                             [](const Combination &a, const Combination &b) { return a.length > b.length; }),
            found);
        if (kept_.size() > keep)
            kept_.pop_back();
    }

    const BundleBuckets *buckets_ = nullptr;
    std::vector<LineSegmentRegistration> chosen_; // the combination before every bucket
    std::vector<Combination> kept_;
    std::uint64_t tried_ = 0;
    bool cut_ = false;
};

} // namespace vectorlib
