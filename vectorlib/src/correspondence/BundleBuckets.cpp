#include "vectorlib/correspondence/BundleBuckets.h"

namespace vectorlib {

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

VECTORLIB_BODY bool BundleBuckets::Entry::operator<(const Entry &o) const {
    return bucket != o.bucket                   ? bucket < o.bucket
           : bundle->length != o.bundle->length ? bundle->length > o.bundle->length
                                                : bundle < o.bundle;
}

} // namespace vectorlib
