#pragma once

#include "vectorlib/relations/RelationSet.h"

#include <algorithm>

namespace vectorlib {

/// The segments of a scan that take part in a match, with their relations. Left out are those that are not
/// finite, lie beyond 1000 km or have no length, and of more than the bound all but the longest; the order
/// stays. An angle edge with the next segment counts only where the two meet: in a set out of order they do
/// not. Memory for n segments: n numbers, and what the bound needs. Keeps its buffers.
class RelationScan {
public:
    /// Takes the segments of a scan in their order.
    void build(const std::vector<TypedSegment> &all, const RelationSettings &settings) {
        chooseUsable(all);
        keepLongest(all, settings.maxSegments);
        segments_.clear();
        for (std::size_t k = 0; k < numbers_.size(); ++k) {
            segments_.push_back(all[numbers_[k]]);
            // A neighbour that is left out takes the angle edge with it.
            TypedSegment &s = segments_.back();
            s.joined = s.joined && k + 1 < numbers_.size() && numbers_[k + 1] == numbers_[k] + 1 &&
                       (s.segment.end() - all[numbers_[k + 1]].segment.begin()).norm() < meeting;
        }
        leftOut_ = all.size() - numbers_.size();
        relations_.build(segments_, settings);
    }
    const std::vector<TypedSegment> &segments() const { return segments_; }
    const RelationSet &relations() const { return relations_; }
    std::size_t leftOut() const { return leftOut_; }
    /// The number of a segment as it was given.
    int given(int number) const { return static_cast<int>(numbers_[static_cast<std::size_t>(number)]); }

private:
    static constexpr double meeting = 0.01; // between ends that are one angle edge; metres

    static bool isWithinReach(Vector2D<double> p) { return std::max(std::abs(p.x), std::abs(p.y)) < 1e6; }

    void chooseUsable(const std::vector<TypedSegment> &all) {
        numbers_.clear();
        for (std::size_t i = 0; i < all.size(); ++i) {
            const LineSegment2D<double> &s = all[i].segment;
            if (isUsable(s) && isWithinReach(s.begin()) && isWithinReach(s.end()) && s.length() > 1e-6)
                numbers_.push_back(i);
        }
    }
    void keepLongest(const std::vector<TypedSegment> &all, std::size_t most) {
        if (numbers_.size() <= most)
            return;
        std::nth_element(numbers_.begin(), numbers_.begin() + std::ptrdiff_t(most), numbers_.end(),
                         [&](std::size_t a, std::size_t b) {
                             const double la = all[a].segment.length(), lb = all[b].segment.length();
                             return la != lb ? la > lb : a < b;
                         });
        numbers_.resize(most);
        std::sort(numbers_.begin(), numbers_.end());
    }

    std::vector<std::size_t> numbers_;
    std::vector<TypedSegment> segments_;
    RelationSet relations_;
    std::size_t leftOut_ = 0;
};

} // namespace vectorlib
