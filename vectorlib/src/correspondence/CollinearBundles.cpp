#include "vectorlib/correspondence/CollinearBundles.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY const std::vector<Bundle> &CollinearBundles::operator()(std::vector<PotentialPair> &pairs) {
    std::sort(pairs.begin(), pairs.end(), [](const PotentialPair &a, const PotentialPair &b) {
        return a.length != b.length ? a.length > b.length : before(a.numbers, b.numbers);
    });
    bundles_.clear();
    next_.assign(pairs.size(), -1);
    pairs_ = &pairs;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        place(static_cast<int>(i));
    return bundles_;
}

VECTORLIB_BODY void CollinearBundles::place(int number) {
    const PotentialPair &p = pair(number);
    Bundle *best = nullptr;
    double least = ambiguity;
    for (Bundle &bundle : bundles_) {
        const double energy = energyOf(p, bundle);
        if (energy <= least && std::abs(p.normal.cross(bundle.normal)) <= reliability) {
            least = energy;
            best = &bundle;
        }
    }
    if (!best) {
        bundles_.push_back({p.normal, p.shift, p.alpha, 0, {}, -1});
        best = &bundles_.back();
        best->sums.stiffness = stiffness;
    }
    join(*best, number);
}

VECTORLIB_BODY void CollinearBundles::join(Bundle &bundle, int number) {
    const PotentialPair &p = pair(number);
    const double share = p.length / (bundle.sums.weight() + p.length);
    bundle.alpha += share * wrapAngle(p.alpha - bundle.alpha);
    bundle.shift += share * (side(p, bundle) * p.shift - bundle.shift);
    bool known = false;
    for (int i = bundle.first; i >= 0 && !known; i = next(i))
        known = pair(i).numbers.moving == p.numbers.moving;
    bundle.length += known ? 0 : p.length;
    bundle.sums.add(p.sums);
    next_[static_cast<std::size_t>(number)] = bundle.first;
    bundle.first = number;
}

VECTORLIB_BODY void BundleBuckets::operator()(const std::vector<Bundle> &bundles) {
    order_.clear();
    for (const Bundle &bundle : bundles)
        order_.push_back({&bundle, 0});
    std::sort(order_.begin(), order_.end()); // all in bucket 0 as yet: longest first
    leaders_.clear();
    for (Entry &entry : order_) {
        while (entry.bucket < leaders_.size() &&
               std::abs(leaders_[entry.bucket]->normal.cross(entry.bundle->normal)) > reliability)
            ++entry.bucket;
        if (entry.bucket == leaders_.size())
            leaders_.push_back(entry.bundle);
    }
    std::sort(order_.begin(), order_.end());
    starts_.assign(leaders_.size() + 1, order_.size());
    for (std::size_t i = order_.size(); i-- > 0;)
        starts_[order_[i].bucket] = i;
    remaining_.assign(leaders_.size() + 1, 0);
    for (std::size_t b = leaders_.size(); b-- > 0;)
        remaining_[b] = remaining_[b + 1] + leaders_[b]->length;
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
