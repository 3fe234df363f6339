#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/relations/BinnedOrder.h"
#include "vectorlib/relations/Corner.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/Relations.h"
#include "vectorlib/relations/TypedSegment.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// All geometric relations of a scan's segments, each kind in the order of its first parameter, so that those
/// that match a given one are found by a range query. Pose-free thesis chapter 4. Keeps its buffers.
class RelationSet {
public:
    std::size_t virtualEdgesLeftOut = 0;

    /// Copies what it needs of the settings' windows; the segments stay with the caller.
    void build(const std::vector<TypedSegment> &segments, const RelationSettings &settings);
    const std::vector<Corner> &corners() const { return corners_; }
    const std::vector<AngleRelation> &angles() const { return angles_; }
    const std::vector<ParallelRelation> &parallels() const { return parallels_; }
    const std::vector<CornerRelation> &cornerRelations() const { return cornerRelations_; }

    /// Calls take(number) for every segment whose length may be that of the given one: complete ones by a
    /// range of lengths, others as Algorithm 2 says. Slack of ends is left to the consistency table.
    template <typename Take>
    void lengthsLike(const TypedSegment &s, Take take) const {
        const double length = s.segment.length();
        const double wide = window_ + widestSlack_ + s.begin.slack + s.end.slack;
        // Shorter complete ones are out, and where this one is complete, so are longer ones but for those
        // that are complete themselves and no longer than the window, and incomplete longer ones.
        const auto from = std::lower_bound(complete_.begin(), complete_.end(), length - wide, lessThan);
        for (auto i = from; i != complete_.end() && (!s.isComplete() || i->length <= length + wide); ++i)
            take(i->number);
        for (auto i = incomplete_.begin();
             i != incomplete_.end() && (!s.isComplete() || i->length <= length + wide); ++i)
            take(i->number);
    }
    /// Calls take(relation) for those whose parameters match; returns how many were looked at.
    template <typename Take>
    std::size_t like(const AngleRelation &r, Take take) const {
        return angleOrder_.near(angleKey(r), [&](const AngleRelation &other) {
            if (isWithin(r.angle, other.angle, turn_))
                take(other);
        });
    }
    /// The same for parallel segments.
    template <typename Take>
    std::size_t like(const ParallelRelation &r, Take take) const {
        return parallelOrder_.near(distanceKey(r.across), [&](const ParallelRelation &other) {
            if (parametersMatch(r, other, static_cast<float>(window_), turn_))
                take(other);
        });
    }
    /// The same for pairs of corners.
    template <typename Take>
    std::size_t like(const CornerRelation &r, Take take) const {
        return cornerOrder_.near(distanceKey(r.distance), [&](const CornerRelation &other) {
            if (parametersMatch(r, other, static_cast<float>(window_), turn_))
                take(other);
        });
    }

private:
    static constexpr int distanceBins = 256;
    struct Length {
        double length = 0;
        int number = 0;
    };
    static bool lessThan(const Length &a, double length) { return a.length < length; }

    double distanceKey(float distance) const { return distance / window_; }
    // As many whole bins as a turn has windows: each at least as wide as one.
    int angleBins() const { return std::max(3, 65536 / std::max(1, static_cast<int>(turn_) + 1)); }
    double angleKey(const AngleRelation &r) const { return double(r.angle) * angleBins() / 65536; }

    void buildLengths(const std::vector<TypedSegment> &segments);
    void buildPairs(const std::vector<TypedSegment> &segments, double angleWindow);
    void buildCorners(const std::vector<TypedSegment> &segments, double least);

    double window_ = 0;
    int turn_ = 0;
    double widestSlack_ = 0;
    CornerFinder findCorners_;
    std::vector<Corner> corners_;
    std::vector<Length> complete_, incomplete_;
    std::vector<AngleRelation> angles_;
    std::vector<ParallelRelation> parallels_;
    std::vector<CornerRelation> cornerRelations_;
    BinnedOrder<AngleRelation> angleOrder_;
    BinnedOrder<ParallelRelation> parallelOrder_;
    BinnedOrder<CornerRelation> cornerOrder_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/RelationSet.cpp")
