#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/CollinearBundles.h"
#include "vectorlib/geometry/Vector2D.h"

#include <vector>

namespace vectorlib {

/// Sorts bundles into buckets: bundles of one bucket have nearly parallel lines, so that any two of them
/// collide and at most one can be part of a solution. Thesis 7.4.1, figure 7.18. The buckets and the bundles
/// in each come longest first. Keeps its buffers.
class BundleBuckets {
public:
    double reliability = 0.10; ///< sine of the largest angle between lines of one bucket

    /// `bundles` must stay as they are while the buckets are in use.
    void operator()(const std::vector<Bundle> &bundles);

    std::size_t size() const { return leaders_.size(); }
    /// The bundles of a bucket are number begin(bucket) to begin(bucket + 1), longest first.
    std::size_t begin(std::size_t bucket) const { return starts_[bucket]; }
    /// The bundle of a number; see begin().
    const Bundle &bundle(std::size_t number) const { return *order_[number].bundle; }
    /// The most length that this bucket and those after it can give; metres.
    double remaining(std::size_t bucket) const { return remaining_[bucket]; }

private:
    struct Entry {
        const Bundle *bundle;
        std::size_t bucket;

        bool operator<(const Entry &o) const;
    };
    std::vector<Entry> order_;            // by bucket
    std::vector<const Bundle *> leaders_; // the longest of every bucket
    std::vector<std::size_t> starts_;
    std::vector<double> remaining_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/BundleBuckets.cpp")
