#include "vectorlib/relations/Corner.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY bool crossing(const LineSegment2D<double> &a, const LineSegment2D<double> &b, double leastSine,
                             Vector2D<double> &point) {
    const double sine = a.direction().cross(b.direction());
    if (!(std::abs(sine) > leastSine))
        return false;
    point = a.begin() + a.direction() * ((b.begin() - a.begin()).cross(b.direction()) / sine);
    return true;
}

VECTORLIB_BODY std::size_t CornerFinder::operator()(const std::vector<TypedSegment> &segments,
                                                    const RelationSettings &settings,
                                                    std::vector<Corner> &corners) {
    corners.clear();
    for (std::size_t i = 0; i < segments.size(); ++i)
        addReal(segments, i, settings.distanceWindow, corners);
    return addVirtual(segments, settings, corners);
}

VECTORLIB_BODY void CornerFinder::addReal(const std::vector<TypedSegment> &segments, std::size_t i,
                                          double window, std::vector<Corner> &corners) {
    const TypedSegment &s = segments[i];
    const int number = static_cast<int>(i);
    if (s.begin.type == EndType::Jump && s.begin.slack <= window)
        corners.push_back({CornerType::JumpBegin, -1, number, s.segment.begin(), s.begin.bound});
    if (s.end.type == EndType::Jump && s.end.slack <= window)
        corners.push_back({CornerType::JumpEnd, number, -1, s.segment.end(), s.end.bound});
    if (s.joined && i + 1 < segments.size())
        corners.push_back({CornerType::Angle, number, number + 1, s.segment.end(),
                           relativeAngle(s.segment, segments[i + 1].segment)});
}

VECTORLIB_BODY std::size_t CornerFinder::addVirtual(const std::vector<TypedSegment> &segments,
                                                    const RelationSettings &settings,
                                                    std::vector<Corner> &corners) {
    candidates_.clear();
    const double sine = std::sin(settings.virtualAngle);
    for (std::size_t i = 0; i < segments.size(); ++i)
        for (std::size_t j = i + 1; j < segments.size(); ++j) {
            const LineSegment2D<double> &a = segments[i].segment, &b = segments[j].segment;
            Vector2D<double> point;
            if ((segments[i].joined && j == i + 1) || !crossing(a, b, sine, point))
                continue;
            const double far = std::max(lengthsTo(a, point), lengthsTo(b, point));
            if (far <= settings.virtualReach)
                candidates_.push_back({far,
                                       {CornerType::Virtual, static_cast<int>(i), static_cast<int>(j), point,
                                        relativeAngle(a, b)}});
        }
    return keepNearest(settings.maxVirtualEdges, corners);
}

VECTORLIB_BODY std::size_t CornerFinder::keepNearest(std::size_t most, std::vector<Corner> &corners) {
    const std::size_t found = candidates_.size(), kept = std::min(found, most);
    const auto order = [](const Corner &c) { return (c.first << 8) + c.second; };
    if (kept < found)
        std::nth_element(candidates_.begin(), candidates_.begin() + std::ptrdiff_t(kept), candidates_.end(),
                         [&](const Candidate &a, const Candidate &b) {
                             return a.far != b.far ? a.far < b.far : order(a.corner) < order(b.corner);
                         });
    candidates_.resize(kept);
    std::sort(candidates_.begin(), candidates_.end(),
              [&](const Candidate &a, const Candidate &b) { return order(a.corner) < order(b.corner); });
    for (const Candidate &c : candidates_)
        corners.push_back(c.corner);
    return found - kept;
}

VECTORLIB_BODY double CornerFinder::lengthsTo(const LineSegment2D<double> &s, Vector2D<double> point) {
    const double t = s.along(point), length = s.length();
    return std::max({-t, t - length, 0.0}) / length;
}

VECTORLIB_BODY void CornerTable::fill(const std::vector<Corner> &rows, const std::vector<Corner> &columns,
                                      const ConsistencyTable &segments, double window) {
    columns_ = columns.size();
    cells_.resize(rows.size() * columns_);
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = 0; j < columns_; ++j)
            cells_[i * columns_ + j] = typesMatch(rows[i].type, columns[j].type) &&
                                       segmentsMatch(rows[i], columns[j], segments) &&
                                       anglesMayMatch(rows[i], columns[j], window);
}

VECTORLIB_BODY bool CornerTable::typesMatch(CornerType a, CornerType b) {
    if (a == CornerType::Virtual || b == CornerType::Virtual)
        return a == b;
    return a == b || a == CornerType::Angle || b == CornerType::Angle;
}

VECTORLIB_BODY bool CornerTable::segmentsMatch(const Corner &a, const Corner &b,
                                               const ConsistencyTable &segments) {
    return (a.first < 0 || b.first < 0 || segments(a.first, b.first)) &&
           (a.second < 0 || b.second < 0 || segments(a.second, b.second));
}

VECTORLIB_BODY bool CornerTable::anglesMayMatch(const Corner &a, const Corner &b, double window) {
    const bool isJumpA = a.first < 0 || a.second < 0, isJumpB = b.first < 0 || b.second < 0;
    if (isJumpA && isJumpB)
        return true; // bounds of two hidden segments never contradict each other
    if (isJumpA || isJumpB) {
        const Corner &jump = isJumpA ? a : b, &seen = isJumpA ? b : a;
        return seen.angle >= pi - window && seen.angle <= jump.angle + window;
    }
    return anglesMatch(a.angle, b.angle, window);
}

} // namespace vectorlib
