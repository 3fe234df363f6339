#include "vectorlib/relations/LocalMap.h"

#include "vectorlib/geometry/LineSegment2D.h"

namespace vectorlib {

VECTORLIB_BODY void LocalMap::update(const std::vector<CorrespondencePair> &pairs,
                                     const std::vector<TypedSegment> &scan, const Transformation2D &pose) {
    ids_.assign(scan.size(), -1);
    for (const CorrespondencePair &p : pairs)
        mergePair(p, scan, pose);
    for (std::size_t i = 0; i < scan.size(); ++i)
        if (ids_[i] < 0)
            ids_[i] = mergeOverlapping(edgeOf(scan[i], pose));
    for (std::size_t i = 0; i < scan.size(); ++i)
        if (ids_[i] < 0 && isUsable(scan[i].segment))
            ids_[i] = map_.add(edgeOf(scan[i], pose));
    last_ = ids_;
}

VECTORLIB_BODY EdgeRaw2D LocalMap::edgeOf(const TypedSegment &s, const Transformation2D &pose) {
    EdgeRaw2D edge(s.sums, s.segment, 0);
    if (s.sums.n == 0) { // as of its two ends
        const Vector2D<double> ends[] = {s.segment.begin(), s.segment.end()};
        edge.sums = TlsSums::of(std::begin(ends), std::end(ends));
    }
    return pose * edge;
}

VECTORLIB_BODY void LocalMap::mergePair(const CorrespondencePair &p, const std::vector<TypedSegment> &scan,
                                        const Transformation2D &pose) {
    const auto before = static_cast<std::size_t>(p.fixed), now = static_cast<std::size_t>(p.moving);
    if (before >= last_.size() || now >= scan.size() || !isAlive(last_[before]))
        return;
    if (map_.merge(last_[before], edgeOf(scan[now], pose)))
        ids_[now] = last_[before];
}

VECTORLIB_BODY int LocalMap::mergeOverlapping(const EdgeRaw2D &edge) {
    const LineSegment2D<double> &s = edge.segment;
    if (!isUsable(s))
        return -1;
    const Vector2D<double> a = s.begin(), b = s.end();
    const double d = distance;
    for (int id : map_.near({std::min(a.x, b.x) - d, std::min(a.y, b.y) - d},
                            {std::max(a.x, b.x) + d, std::max(a.y, b.y) + d})) {
        const LineSegment2D<double> &m = map_.slots()[static_cast<std::size_t>(id)].segment;
        if (m.direction().dot(s.direction()) >= std::cos(angle) && m.overlap(s) > 0 &&
            std::abs(m.length() < s.length() ? s.across(m.middle()) : m.across(s.middle())) <= d &&
            map_.merge(id, edge)) {
            map_.consolidate(id);
            return id;
        }
    }
    return -1;
}

} // namespace vectorlib
