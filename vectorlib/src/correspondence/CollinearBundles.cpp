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

VECTORLIB_BODY double CollinearBundles::energyOf(const PotentialPair &p, const Bundle &bundle) const {
    const double turn = wrapAngle(p.alpha - bundle.alpha);
    const double apart = side(p, bundle) * p.shift - bundle.shift;
    return stiffness.alpha * turn * turn + stiffness.xy * apart * apart;
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

} // namespace vectorlib
