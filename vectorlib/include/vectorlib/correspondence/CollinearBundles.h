#pragma once

#include "vectorlib/correspondence/PotentialPair.h"

#include <algorithm>
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
    const std::vector<Bundle> &operator()(std::vector<PotentialPair> &pairs) {
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
    /// The pair that follows in its bundle, or -1.
    int next(int pair) const { return next_[static_cast<std::size_t>(pair)]; }

private:
    static bool before(const CorrespondencePair &a, const CorrespondencePair &b) {
        return a.moving != b.moving ? a.moving < b.moving : a.fixed < b.fixed;
    }
    const PotentialPair &pair(int i) const { return (*pairs_)[static_cast<std::size_t>(i)]; }

    void place(int number) {
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
    double energyOf(const PotentialPair &p, const Bundle &bundle) const {
        const double turn = wrapAngle(p.alpha - bundle.alpha);
        const double apart = side(p, bundle) * p.shift - bundle.shift;
        return stiffness.alpha * turn * turn + stiffness.xy * apart * apart;
    }
    // Facing walls share a direction, not a normal.
    static double side(const PotentialPair &p, const Bundle &bundle) {
        return p.normal.dot(bundle.normal) < 0 ? -1 : 1;
    }
    void join(Bundle &bundle, int number) {
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

    const std::vector<PotentialPair> *pairs_ = nullptr;
    std::vector<Bundle> bundles_;
    std::vector<int> next_; // of every pair, in its bundle
};

} // namespace vectorlib
