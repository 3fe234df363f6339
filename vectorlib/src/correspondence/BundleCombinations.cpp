#include "vectorlib/correspondence/BundleCombinations.h"

namespace vectorlib {

VECTORLIB_BODY bool SamePose::operator()(const Transformation2D &a, const Transformation2D &b) const {
    return (a.translation() - b.translation()).norm() < distance &&
           std::abs(wrapAngle(a.alpha() - b.alpha())) < angle;
}

VECTORLIB_BODY const std::vector<Combination> &BundleCombinations::operator()(const BundleBuckets &buckets) {
    buckets_ = &buckets;
    kept_.clear();
    tried_ = 0;
    cut_ = false;
    chosen_.assign(buckets.size() + 1, LineSegmentRegistration());
    extend(0, 0, 0);
    return kept_;
}

VECTORLIB_BODY void BundleCombinations::extend(std::size_t bucket, std::size_t count, double length) {
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

VECTORLIB_BODY void BundleCombinations::conclude(double length) {
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

} // namespace vectorlib
