#include "vectorlib/relations/TypedSegmentExtractor.h"
#include "vectorlib/tls/TlsFit.h"

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

VECTORLIB_BODY void TypedSegmentExtractor::setScanner(double fieldOfView, std::size_t rays) {
    segment.settings = EarSettings::forScanner(fieldOfView, rays);
    step_ = rays > 1 ? fieldOfView / double(rays - (segment.settings.closed ? 0 : 1)) : 0;
    vectorize.settings.sigma = 0.025;
    vectorize.settings.polyline = false;
}

VECTORLIB_BODY const std::vector<TypedSegment> &TypedSegmentExtractor::operator()(PointSpan<float> given) {
    const PointSpan<float> scan = order_(given);
    takeLines(scan);
    segments_.clear();
    for (std::size_t i = 0; i < lines_.size(); ++i)
        if (lines_[i].isKept)
            segments_.push_back(typed(scan, i));
    return segments_;
}

VECTORLIB_BODY void TypedSegmentExtractor::takeLines(PointSpan<float> scan) {
    lines_.clear();
    const Segmentation &clusters = segment(scan);
    for (std::size_t c = 0; c < clusters.size(); ++c) {
        cluster_.clear();
        const std::size_t start = clusters.starts[c];
        for (std::size_t i = start; i < clusters.starts[c + 1]; ++i)
            cluster_.push_back(scan[static_cast<std::size_t>(clusters.order[i])]);
        for (const VectorizedLine &line : vectorize(cluster_))
            lines_.push_back({static_cast<std::size_t>(clusters.order[start + line.first]),
                              static_cast<std::size_t>(clusters.order[start + line.last]), line,
                              innerSums(line), isKnown(line)});
    }
    std::sort(lines_.begin(), lines_.end(),
              [](const ScanLine &a, const ScanLine &b) { return a.first < b.first; });
}

VECTORLIB_BODY TlsSums TypedSegmentExtractor::innerSums(const VectorizedLine &line) const {
    if (line.last < line.first + leastTrimmed - 1)
        return line.sums;
    const auto first = cluster_.begin() + static_cast<std::ptrdiff_t>(line.first) + 1;
    const auto last = cluster_.begin() + static_cast<std::ptrdiff_t>(line.last);
    return TlsSums::of(first, last);
}

VECTORLIB_BODY bool TypedSegmentExtractor::isKnown(const VectorizedLine &line) const {
    if (!line.line.isValid() || line.sums.n < double(minPoints) || !(line.segment.length() >= minLength))
        return false;
    const double scatter = line.sums.n > 2 ? line.sigma : 0;
    const LineCovariance known = lineCovariance(line.sums, std::max(noise, scatter));
    return known.valid && known.matrix(0, 0) <= maxAngleError * maxAngleError;
}

VECTORLIB_BODY TypedSegment TypedSegmentExtractor::typed(PointSpan<float> scan, std::size_t i) const {
    const ScanLine &l = lines_[i];
    TypedSegment s;
    s.sums = l.inner;
    Point begin = l.line.segment.begin(), end = l.line.segment.end();
    const bool isAfter = i > 0 && isCorner(scan, lines_[i - 1], l);
    const bool isBefore = i + 1 < lines_.size() && isCorner(scan, l, lines_[i + 1]);
    if (isAfter)
        s.begin = corner(lines_[i - 1], l, begin);
    else if (l.first > 0)
        s.begin = jumpOrInterior(l, scan[l.first], scan[l.first - 1], -1, begin);
    if (isBefore)
        s.end = corner(l, lines_[i + 1], end);
    else if (l.last + 1 < scan.size())
        s.end = jumpOrInterior(l, scan[l.last], scan[l.last + 1], 1, end);
    s.joined = isBefore;
    s.segment = LineSegment2D<double>(begin, end, l.line.segment.direction());
    return s;
}

VECTORLIB_BODY bool TypedSegmentExtractor::isCorner(PointSpan<float> scan, const ScanLine &a,
                                                    const ScanLine &b) const {
    if (!a.isKept || !b.isKept || a.last + 1 != b.first)
        return false;
    const Point p(scan[a.last]), q(scan[b.first]);
    Point at;
    if (!crossing(a.line.segment, b.line.segment, std::sin(15 * pi / 180), at) || !isNext(p, q))
        return false;
    const double slack = std::sin(beamSlack * step_) * at.norm();
    const double near = 2 * ((p - q).norm() + step_ * at.norm());
    return p.normalized().cross(at) >= -slack && at.cross(q.normalized()) >= -slack && at.dot(p) > 0 &&
           (at - p).norm() <= near && (at - q).norm() <= near;
}

VECTORLIB_BODY SegmentEnd TypedSegmentExtractor::corner(const ScanLine &a, const ScanLine &b, Point &at) {
    crossing(a.line.segment, b.line.segment, 0, at);
    SegmentEnd end;
    end.type = EndType::Angle;
    return end;
}

VECTORLIB_BODY SegmentEnd TypedSegmentExtractor::jumpOrInterior(const ScanLine &l, Vector2D<float> own,
                                                                Vector2D<float> neighbour, int side,
                                                                Point &at) const {
    SegmentEnd result;
    const Point p(own), q(neighbour), beam = q.normalized();
    const Point n = l.line.segment.normal();
    const double towards = n.dot(beam), range = n.dot(l.line.segment.begin()) / towards;
    const bool meets = std::isfinite(range) && range > 0;
    const bool isBeside = side > 0 ? isNext(p, q) : isNext(q, p);
    if (!meets || !isBeside || !(q.norm() > range + jump))
        return result;
    const Point along = l.line.segment.direction() * double(side);
    const double gap = std::max(0.0, (beam * range - at).dot(along));
    result.type = EndType::Jump;
    result.slack = gap / 2;
    if (gap <= 0.4)
        at += along * (gap / 2);
    // What is hidden lies on the far side of the beam, as seen from the segment.
    result.bound = 2 * pi - std::acos(std::clamp(along.dot(p.normalized()), -1.0, 1.0));
    return result;
}

} // namespace vectorlib
