#include "vectorlib/relations/RelationSet.h"

namespace vectorlib {

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
