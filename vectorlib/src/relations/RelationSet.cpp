#include "vectorlib/relations/RelationSet.h"

namespace vectorlib {

VECTORLIB_BODY TurnPart turnPart(double radians) {
    return static_cast<TurnPart>(static_cast<std::int32_t>(std::lround(radians * (32768 / pi))));
}

VECTORLIB_BODY bool parallelRelation(const TypedSegment &a, const TypedSegment &b, double window,
                                     ParallelRelation &relation) {
    const double angle = relativeAngle(a.segment, b.segment);
    if (!anglesMatch(angle, 0, window) && !anglesMatch(angle, pi, window))
        return false;
    relation.angle = turnPart(angle);
    relation.across = static_cast<float>(
        (std::abs(a.segment.across(b.segment.middle())) + std::abs(b.segment.across(a.segment.middle()))) /
        2);
    // Both as intervals along the first; the ends of the second in the order along it.
    const bool isSame = anglesMatch(angle, 0, pi / 2);
    const double begin = a.segment.along(isSame ? b.segment.begin() : b.segment.end());
    const double end = a.segment.along(isSame ? b.segment.end() : b.segment.begin());
    const SegmentEnd &atBegin = isSame ? b.begin : b.end, &atEnd = isSame ? b.end : b.begin;
    const double length = a.segment.length();
    const double overlap = std::min(length, end) - std::max(0.0, begin);
    if (overlap > 0) {
        relation.kind = OverlapKind::Overlap;
        const SegmentEnd &from = begin > 0 ? atBegin : a.begin, &to = end < length ? atEnd : a.end;
        relation.isLeast = !from.isEdge() || !to.isEdge();
        relation.along = static_cast<float>(overlap);
        return true;
    }
    const bool isAfter = begin >= length; // the second lies beyond the end of the first
    const bool isOpen = isAfter ? !a.end.isEdge() || !atBegin.isEdge() : !a.begin.isEdge() || !atEnd.isEdge();
    relation.kind = isOpen ? OverlapKind::MayOverlap : OverlapKind::NoOverlap;
    relation.isLeast = false;
    relation.along = isOpen ? 0 : static_cast<float>(-overlap);
    return true;
}

VECTORLIB_BODY bool cornerRelation(const std::vector<TypedSegment> &segments, const Corner &a,
                                   const Corner &b, double least, CornerRelation &relation) {
    const Vector2D<double> line = b.point - a.point;
    const double distance = line.norm();
    if (!(distance >= least))
        return false;
    relation.distance = static_cast<float>(distance);
    relation.present = 0;
    const double direction = std::atan2(line.y, line.x);
    const int numbers[4] = {a.first, a.second, b.first, b.second};
    for (std::size_t i = 0; i < 4; ++i) {
        relation.angles[i] = 0;
        if (numbers[i] < 0)
            continue;
        const Vector2D<double> v = segments[static_cast<std::size_t>(numbers[i])].segment.direction();
        relation.angles[i] = turnPart(direction - std::atan2(v.y, v.x));
        relation.present = static_cast<std::uint8_t>(relation.present | 1u << i);
    }
    return true;
}

VECTORLIB_BODY bool parametersMatch(const ParallelRelation &a, const ParallelRelation &b, float window,
                                    int turn) {
    if (a.kind != b.kind || std::abs(a.across - b.across) > window || !isWithin(a.angle, b.angle, turn))
        return false;
    if (a.kind == OverlapKind::MayOverlap || (a.isLeast && b.isLeast))
        return true;
    // An overlap that is seen in part is no longer than the whole of it.
    return (a.isLeast || a.along >= b.along - window) && (b.isLeast || b.along >= a.along - window) &&
           (!a.isLeast || a.along <= b.along + window) && (!b.isLeast || b.along <= a.along + window);
}

VECTORLIB_BODY bool parametersMatch(const CornerRelation &a, const CornerRelation &b, float window,
                                    int turn) {
    if (std::abs(a.distance - b.distance) > window)
        return false;
    const unsigned both = a.present & b.present;
    for (unsigned i = 0; i < 4; ++i)
        if ((both >> i & 1u) && !isWithin(a.angles[i], b.angles[i], turn))
            return false;
    return true;
}

VECTORLIB_BODY void RelationSet::build(const std::vector<TypedSegment> &segments,
                                       const RelationSettings &settings) {
    window_ = settings.distanceWindow;
    turn_ = turnPart(settings.angleWindow);
    virtualEdgesLeftOut = findCorners_(segments, settings, corners_);
    buildLengths(segments);
    buildPairs(segments, settings.angleWindow);
    buildCorners(segments, settings.leastEdgeDistance);
}

VECTORLIB_BODY void RelationSet::buildLengths(const std::vector<TypedSegment> &segments) {
    complete_.clear();
    incomplete_.clear();
    widestSlack_ = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const TypedSegment &s = segments[i];
        (s.isComplete() ? complete_ : incomplete_).push_back({s.segment.length(), static_cast<int>(i)});
        for (const SegmentEnd *end : {&s.begin, &s.end})
            if (end->isEdge())
                widestSlack_ = std::max(widestSlack_, 2 * end->slack);
    }
    for (std::vector<Length> *lengths : {&complete_, &incomplete_})
        std::sort(lengths->begin(), lengths->end(), [](const Length &a, const Length &b) {
            return a.length != b.length ? a.length < b.length : a.number < b.number;
        });
}

VECTORLIB_BODY void RelationSet::buildPairs(const std::vector<TypedSegment> &segments, double angleWindow) {
    angles_.clear();
    parallels_.clear();
    for (std::size_t i = 0; i < segments.size(); ++i)
        for (std::size_t j = i + 1; j < segments.size(); ++j) {
            AngleRelation a;
            ParallelRelation p;
            a.first = p.first = static_cast<std::int16_t>(i);
            a.second = p.second = static_cast<std::int16_t>(j);
            a.angle = turnPart(relativeAngle(segments[i].segment, segments[j].segment));
            angles_.push_back(a);
            if (parallelRelation(segments[i], segments[j], angleWindow, p))
                parallels_.push_back(p);
        }
    angleOrder_.build(angles_, angleBins(), [this](const AngleRelation &r) { return angleKey(r); });
    parallelOrder_.build(parallels_, distanceBins,
                         [this](const ParallelRelation &r) { return distanceKey(r.across); });
}

VECTORLIB_BODY void RelationSet::buildCorners(const std::vector<TypedSegment> &segments, double least) {
    cornerRelations_.clear();
    for (std::size_t i = 0; i < corners_.size(); ++i)
        for (std::size_t j = i + 1; j < corners_.size(); ++j) {
            CornerRelation r;
            r.first = static_cast<std::int16_t>(i);
            r.second = static_cast<std::int16_t>(j);
            if (cornerRelation(segments, corners_[i], corners_[j], least, r))
                cornerRelations_.push_back(r);
        }
    cornerOrder_.build(cornerRelations_, distanceBins,
                       [this](const CornerRelation &r) { return distanceKey(r.distance); });
}

} // namespace vectorlib
