#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/TypedSegment.h"
#include "vectorlib/relations/TypedSegmentExtractor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vectorlib {

/// An angle as a 65536th of a turn: differences wrap by themselves.
using TurnPart = std::uint16_t;

/// The part of a turn of an angle in radians.
TurnPart turnPart(double radians);
/// Whether two angles differ by at most `window`; 65536ths of a turn.
inline bool isWithin(TurnPart a, TurnPart b, int window) {
    return std::abs(static_cast<std::int16_t>(static_cast<TurnPart>(a - b))) <= window;
}

/// Relation A of pose-free thesis 4.3: two segments and the relative angle between them.
struct AngleRelation {
    std::int16_t first = 0, second = 0;
    TurnPart angle = 0;
};

/// How two parallel segments lie beside each other. Pose-free thesis 4.4.
enum class OverlapKind : std::uint8_t { Overlap, MayOverlap, NoOverlap };

/// Relation P of pose-free thesis 4.4: two parallel segments.
struct ParallelRelation {
    std::int16_t first = 0, second = 0;
    TurnPart angle = 0;
    OverlapKind kind = OverlapKind::MayOverlap;
    bool isLeast = false; ///< the overlap may be longer: an end that limits it is interior
    float along = 0;      ///< overlap length, or the gap of NoOverlap; metres. MayOverlap: undefined, 0
    float across = 0;     ///< distance of the lines; metres
};

/// Relation E of pose-free thesis 4.5: two corners, their distance, and the angles from their segments to the
/// line from the first corner to the second. A jump has one segment, and one angle is missing.
struct CornerRelation {
    std::int16_t first = 0, second = 0;
    float distance = 0;                ///< metres
    TurnPart angles[4] = {0, 0, 0, 0}; ///< of the first corner's segments, then the second's
    std::uint8_t present = 0;          ///< bit i: angles[i] is there
};

/// How two segments of one scan lie beside each other, when they are parallel within the window; false when
/// they are not.
bool parallelRelation(const TypedSegment &a, const TypedSegment &b, double window,
                      ParallelRelation &relation);

/// Two corners of one scan; false when they are too near to each other to have a direction.
bool cornerRelation(const std::vector<TypedSegment> &segments, const Corner &a, const Corner &b, double least,
                    CornerRelation &relation);

/// Whether the parameters of two relations are equal within the windows (metres; 65536ths of a turn).
bool parametersMatch(const ParallelRelation &a, const ParallelRelation &b, float window, int turn);
/// The same for two relations of corners: angles that both have, and the distance.
bool parametersMatch(const CornerRelation &a, const CornerRelation &b, float window, int turn);

/// Things ordered by a parameter in bins as wide as a window: all that lie within the window of a value are
/// in the three bins around it. The last bin is followed by the first, so that no value is too large and
/// those of a circle meet. Built in linear time; keeps its buffers.
template <typename Thing>
class BinnedOrder {
public:
    /// key(thing) in units of the window, 0 and above; at least three bins.
    template <typename Key>
    void build(const std::vector<Thing> &things, int bins, Key key) {
        starts_.assign(static_cast<std::size_t>(bins) + 1, 0);
        for (const Thing &t : things)
            ++starts_[bin(key(t)) + 1];
        for (std::size_t i = 1; i < starts_.size(); ++i)
            starts_[i] += starts_[i - 1];
        next_.assign(starts_.begin(), starts_.end() - 1);
        things_.resize(things.size());
        for (const Thing &t : things)
            things_[next_[bin(key(t))]++] = t;
    }
    /// Calls take(thing) for all whose key is within 1 of this one, and for others of the same bins; returns
    /// for how many.
    template <typename Take>
    std::size_t near(double key, Take take) const {
        std::size_t visited = 0;
        const std::size_t last = starts_.size() - 2, middle = bin(key);
        for (const std::size_t b : {middle > 0 ? middle - 1 : last, middle, middle < last ? middle + 1 : 0}) {
            for (std::size_t i = starts_[b]; i < starts_[b + 1]; ++i)
                take(things_[i]);
            visited += starts_[b + 1] - starts_[b];
        }
        return visited;
    }

private:
    std::size_t bin(double key) const {
        constexpr double most = 1e9; // what lies beyond shares a bin
        const std::size_t bins = starts_.size() - 1;
        const auto number = static_cast<std::size_t>(std::min(key, most));
        return number < bins ? number : number % bins;
    }

    std::vector<std::size_t> starts_, next_;
    std::vector<Thing> things_;
};

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
