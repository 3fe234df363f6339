#include "vectorlib/relations/TypedSegmentExtractor.h"

#include "vectorlib/tls/LineCovariance.h"

namespace vectorlib {

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
