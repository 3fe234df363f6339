#include "vectorlib/correspondence/PublishedBundles.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY PublishedBundle::PublishedBundle(const PotentialPair &first)
    : normal(first.normal)
    , alpha(first.alpha) {
    sums.stiffness = first.sums.stiffness;
}

VECTORLIB_BODY void PublishedBundle::add(const PotentialPair &pair) {
    const double turn = wrapAngle(pair.alpha - alpha);
    const double shift = (pair.normal.dot(normal) < 0 ? -1 : 1) * pair.shift; // facing walls
    sums.add(pair.sums);
    turns += pair.length * turn;
    turns2 += pair.length * turn * turn;
    shifts += pair.length * shift;
    shifts2 += pair.length * shift * shift;
}

VECTORLIB_BODY double PublishedBundle::ambiguity() const {
    const double w = sums.weight();
    return sums.stiffness.alpha * std::max(0.0, turns2 - turns * turns / w) +
           sums.stiffness.xy * std::max(0.0, shifts2 - shifts * shifts / w);
}

VECTORLIB_BODY const std::vector<PublishedBundle> &
PublishedBundles::operator()(const std::vector<PotentialPair> &pairs) {
    bundles_.clear();
    for (std::size_t i = 0; i < pairs.size(); ++i)
        place(pairs[i], static_cast<int>(i));
    buckets_.clear();
    for (std::size_t i = 0; i < bundles_.size(); ++i)
        putIntoBucket(i);
    return bundles_;
}

VECTORLIB_BODY void PublishedBundles::place(const PotentialPair &pair, int number) {
    for (PublishedBundle &bundle : bundles_) {
        PublishedBundle with = bundle;
        with.add(pair);
        if (with.sums.reliability() <= reliability && with.ambiguity() <= ambiguity) {
            bundle = std::move(with);
            bundle.pairs.push_back(number);
            return;
        }
    }
    bundles_.emplace_back(pair);
    bundles_.back().add(pair);
    bundles_.back().pairs.push_back(number);
}

VECTORLIB_BODY bool PublishedBundles::collide(std::size_t a, std::size_t b) const {
    LineSegmentRegistration joint = bundles_[a].sums;
    joint.add(bundles_[b].sums);
    return joint.reliability() <= reliability;
}

VECTORLIB_BODY void PublishedBundles::putIntoBucket(std::size_t bundle) {
    const auto fits = [&](const std::vector<std::size_t> &bucket) {
        return std::all_of(bucket.begin(), bucket.end(),
                           [&](std::size_t other) { return collide(bundle, other); });
    };
    const auto found = std::find_if(buckets_.begin(), buckets_.end(), fits);
    bundles_[bundle].bucket = static_cast<std::size_t>(found - buckets_.begin());
    if (found == buckets_.end())
        buckets_.push_back({bundle});
    else
        found->push_back(bundle);
}

} // namespace vectorlib
