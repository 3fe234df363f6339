#pragma once

#include "vectorlib/correspondence/PublishedBundles.h"

#include <cstdint>

namespace vectorlib {

/// Bundles of two or more buckets that together are reliable and not ambiguous.
struct PublishedCombination {
    LineSegmentRegistration sums;
    std::vector<std::size_t> bundles; ///< their numbers

    double length() const { return sums.weight(); } ///< metres
};

/// Every reliable, unambiguous combination of bundles, at most one of each bucket; thesis 7.4.1, last stage.
/// One to which another bundle can be added is told in the number of parts only: the appendices show none of
/// them. Energy (7.44) only grows as bundles join, so that a branch ends where it is beyond the threshold.
class PublishedCombinations {
public:
    double reliability = 0.10;    ///< least of a combination
    double ambiguity = 0.0025;    ///< most of a combination; m^2
    std::size_t keep = 100;       ///< the longest ones
    std::uint64_t most = 1000000; ///< bundles tried; then the search ends with what it has

    /// Longest first; valid until the next call.
    const std::vector<PublishedCombination> &operator()(const PublishedBundles &sorted) {
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
    std::uint64_t found() const { return found_; }                           ///< all of them
    std::uint64_t parts() const { return parts_; }                           ///< parts of larger ones
    std::uint64_t leftOut() const { return found_ - parts_ - kept_.size(); } ///< beyond `keep`
    std::uint64_t tried() const { return tried_; }                           ///< bundles
    bool isCut() const { return cut_; } ///< whether `most` ended the search before its end

private:
    const PublishedBundle &bundle(std::size_t number) const { return sorted_->bundles()[number]; }

    // Whether a bundle may join; false, too, where the bound is reached.
    bool joins(std::size_t number, const LineSegmentRegistration &sums, LineSegmentRegistration &joint) {
        cut_ = cut_ || tried_ >= most;
        if (cut_)
            return false;
        ++tried_;
        joint = sums;
        joint.add(bundle(number).sums);
        return joint.ambiguity().total() <= ambiguity;
    }
    void extend(std::size_t bucket, const LineSegmentRegistration &sums) {
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
    void conclude(const LineSegmentRegistration &sums) {
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
    bool isPart(const LineSegmentRegistration &sums) {
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

    const PublishedBundles *sorted_ = nullptr;
    std::vector<std::size_t> chosen_;
    std::vector<PublishedCombination> kept_;
    std::uint64_t found_ = 0, parts_ = 0, tried_ = 0;
    bool cut_ = false;
};

} // namespace vectorlib
