#include "vectorlib/relations/ConsistencyTable.h"

namespace vectorlib {

VECTORLIB_BODY bool lengthsMayMatch(const TypedSegment &a, const TypedSegment &b, double window) {
    const double la = a.segment.length(), lb = b.segment.length();
    const auto slack = [](const TypedSegment &s) {
        return (s.begin.isEdge() ? s.begin.slack : 0) + (s.end.isEdge() ? s.end.slack : 0);
    };
    if (std::abs(la - lb) <= window + slack(a) + slack(b))
        return true;
    return !(la < lb ? a : b).isComplete();
}

VECTORLIB_BODY void ConsistencyTable::fill(const Segments &rows, const Segments &columns,
                                           const RelationSettings &settings) {
    columns_ = columns.size();
    cells_.resize(rows.size() * columns_);
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = 0; j < columns_; ++j)
            cells_[i * columns_ + j] = lengthsMayMatch(rows[i], columns[j], settings.distanceWindow) &&
                                       endsMayMatch(rows, i, columns, j, settings) &&
                                       beginsMayMatch(rows, i, columns, j, settings);
}

VECTORLIB_BODY bool ConsistencyTable::endsMayMatch(const Segments &a, std::size_t i, const Segments &b,
                                                   std::size_t j, const RelationSettings &settings) {
    const bool isA = a[i].joined && i + 1 < a.size(), isB = b[j].joined && j + 1 < b.size();
    if (isA && isB)
        return cornersMayMatch(a, i, b, j, settings);
    if (isA && b[j].end.type == EndType::Jump)
        return keepsBound(a, i, b[j].end, settings);
    if (isB && a[i].end.type == EndType::Jump)
        return keepsBound(b, j, a[i].end, settings);
    return true;
}

VECTORLIB_BODY bool ConsistencyTable::beginsMayMatch(const Segments &a, std::size_t i, const Segments &b,
                                                     std::size_t j, const RelationSettings &settings) {
    const bool isA = i > 0 && a[i - 1].joined, isB = j > 0 && b[j - 1].joined;
    if (isA && isB)
        return lengthsMayMatch(a[i - 1], b[j - 1], settings.distanceWindow) &&
               anglesMatch(relativeAngle(a[i - 1].segment, a[i].segment),
                           relativeAngle(b[j - 1].segment, b[j].segment), settings.angleWindow);
    if (isA && b[j].begin.type == EndType::Jump)
        return keepsBound(a, i - 1, b[j].begin, settings);
    if (isB && a[i].begin.type == EndType::Jump)
        return keepsBound(b, j - 1, a[i].begin, settings);
    return true;
}

VECTORLIB_BODY bool ConsistencyTable::cornersMayMatch(const Segments &a, std::size_t i, const Segments &b,
                                                      std::size_t j, const RelationSettings &settings) {
    return lengthsMayMatch(a[i + 1], b[j + 1], settings.distanceWindow) &&
           anglesMatch(relativeAngle(a[i].segment, a[i + 1].segment),
                       relativeAngle(b[j].segment, b[j + 1].segment), settings.angleWindow);
}

VECTORLIB_BODY bool ConsistencyTable::keepsBound(const Segments &a, std::size_t i, const SegmentEnd &jump,
                                                 const RelationSettings &settings) {
    const double angle = relativeAngle(a[i].segment, a[i + 1].segment);
    return angle >= pi - settings.angleWindow && angle <= jump.bound + settings.angleWindow;
}

} // namespace vectorlib
