#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/PublishedBundles.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <cstdint>
#include <vector>

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
    const std::vector<PublishedCombination> &operator()(const PublishedBundles &sorted);
    std::uint64_t found() const { return found_; }                           ///< all of them
    std::uint64_t parts() const { return parts_; }                           ///< parts of larger ones
    std::uint64_t leftOut() const { return found_ - parts_ - kept_.size(); } ///< beyond `keep`
    std::uint64_t tried() const { return tried_; }                           ///< bundles
    bool isCut() const { return cut_; } ///< whether `most` ended the search before its end

private:
    const PublishedBundle &bundle(std::size_t number) const { return sorted_->bundles()[number]; }

    // Whether a bundle may join; false, too, where the bound is reached.
    bool joins(std::size_t number, const LineSegmentRegistration &sums, LineSegmentRegistration &joint);
    void extend(std::size_t bucket, const LineSegmentRegistration &sums);
    void conclude(const LineSegmentRegistration &sums);
    bool isPart(const LineSegmentRegistration &sums);

    const PublishedBundles *sorted_ = nullptr;
    std::vector<std::size_t> chosen_;
    std::vector<PublishedCombination> kept_;
    std::uint64_t found_ = 0, parts_ = 0, tried_ = 0;
    bool cut_ = false;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/PublishedCombinations.cpp")
