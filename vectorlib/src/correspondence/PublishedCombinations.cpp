#include "vectorlib/correspondence/PublishedCombinations.h"

namespace vectorlib {

VECTORLIB_BODY const std::vector<PublishedCombination> &
PublishedCombinations::operator()(const PublishedBundles &sorted) {
    sorted_ = &sorted;
    kept_.clear();
    found_ = parts_ = tried_ = 0;
    cut_ = false;
    chosen_.clear();
    LineSegmentRegistration none;
    if (!sorted.bundles().empty())
        none.stiffness = bundle(0).sums.stiffness;
    extend(0, none);
    return kept_;
}

VECTORLIB_BODY bool PublishedCombinations::joins(std::size_t number, const LineSegmentRegistration &sums,
                                                 LineSegmentRegistration &joint) {
    cut_ = cut_ || tried_ >= most;
    if (cut_)
        return false;
    ++tried_;
    joint = sums;
    joint.add(bundle(number).sums);
    return joint.ambiguity().total() <= ambiguity;
}

VECTORLIB_BODY void PublishedCombinations::extend(std::size_t bucket, const LineSegmentRegistration &sums) {
    if (bucket == sorted_->buckets().size()) {
        if (chosen_.size() > 1 && sums.reliability() >= reliability)
            conclude(sums);
        return;
    }
    LineSegmentRegistration joint;
    for (const std::size_t number : sorted_->buckets()[bucket])
        if (joins(number, sums, joint)) {
            chosen_.push_back(number);
            extend(bucket + 1, joint);
            chosen_.pop_back();
        }
    if (!cut_)
        extend(bucket + 1, sums);
}

VECTORLIB_BODY void PublishedCombinations::conclude(const LineSegmentRegistration &sums) {
    ++found_;
    if (isPart(sums)) {
        ++parts_;
        return;
    }
    const PublishedCombination found{sums, chosen_};
    kept_.insert(std::upper_bound(kept_.begin(), kept_.end(), found,
                                  [](const PublishedCombination &a, const PublishedCombination &b) {
                                      return a.length() > b.length();
                                  }),
                 found);
    if (kept_.size() > keep)
        kept_.pop_back();
}

VECTORLIB_BODY bool PublishedCombinations::isPart(const LineSegmentRegistration &sums) {
    LineSegmentRegistration joint;
    for (std::size_t bucket = 0; bucket < sorted_->buckets().size(); ++bucket) {
        const std::vector<std::size_t> &numbers = sorted_->buckets()[bucket];
        if (std::any_of(chosen_.begin(), chosen_.end(),
                        [&](std::size_t number) { return bundle(number).bucket == bucket; }))
            continue;
        for (const std::size_t number : numbers)
            if (joins(number, sums, joint) && joint.reliability() >= reliability)
                return true;
    }
    return false;
}

} // namespace vectorlib
