#include "vectorlib/mapping/VectorMap.h"

namespace vectorlib {

VECTORLIB_BODY void VectorMap::clear() {
    edges_.clear();
    grid_.clear();
    alive_ = 0;
    changed_.clear();
}

VECTORLIB_BODY int VectorMap::add(const EdgeRaw2D &edge, std::int64_t observations) {
    const int number = static_cast<int>(edges_.size());
    edges_.emplace_back(number, edge, observations);
    grid_.insert(number, edge.segment);
    ++alive_;
    changed_.push_back(number);
    return number;
}

VECTORLIB_BODY bool VectorMap::merge(int number, const EdgeRaw2D &edge, std::int64_t observations) {
    MapEdge &target = edges_[static_cast<std::size_t>(number)];
    const EdgeRaw2D joint = merged(target, edge);
    if (target.observations == 0 || joint.sigma > settings.maxSigma)
        return false;
    take(target, joint, target.observations + observations);
    return true;
}

VECTORLIB_BODY int VectorMap::consolidate(int number) {
    int joined = 0;
    for (bool again = true; again;) {
        again = false;
        for (int other : near(edges_[static_cast<std::size_t>(number)].segment, settings.joinGap))
            if (other != number && join(number, other)) {
                again = true; // the edge grew: look around again
                ++joined;
                break;
            }
    }
    return joined;
}

VECTORLIB_BODY void VectorMap::absorb(int number, int other, std::int64_t observations) {
    MapEdge &a = edges_[static_cast<std::size_t>(number)];
    const MapEdge &b = edges_[static_cast<std::size_t>(other)];
    EdgeRaw2D joint = merged(a, b);
    if (joint.sigma > settings.maxSigma) {
        const LineSegment2D<double> &s = a.segment;
        const double from = std::min({0.0, s.along(b.segment.begin()), s.along(b.segment.end())});
        const double to = std::max({s.length(), s.along(b.segment.begin()), s.along(b.segment.end())});
        joint = {a.sums, s.part(from, to), a.sigma};
    }
    take(a, joint, observations);
    remove(other);
}

VECTORLIB_BODY void VectorMap::assign(const std::vector<MapEdge> &edges) {
    for (const MapEdge &old : edges_)
        if (old.observations > 0)
            changed_.push_back(static_cast<int>(old.id));
    std::vector<int> changed = std::move(changed_);
    const std::size_t known = edges_.size();
    clear();
    for (std::size_t i = 0; i < known; ++i)
        edges_.emplace_back(std::int64_t(i), EdgeRaw2D(), 0);
    for (const MapEdge &e : edges) {
        while (edges_.size() <= static_cast<std::size_t>(e.id))
            edges_.emplace_back(std::int64_t(edges_.size()), EdgeRaw2D(), 0);
        take(edges_[static_cast<std::size_t>(e.id)], e, e.observations);
        ++alive_;
    }
    changed_.insert(changed_.end(), changed.begin(), changed.end());
}

VECTORLIB_BODY void VectorMap::reshape(int number, const LineSegment2D<double> &segment) {
    MapEdge &edge = edges_[static_cast<std::size_t>(number)];
    edge.segment = segment;
    grid_.insert(number, segment);
    changed_.push_back(number);
}

VECTORLIB_BODY void VectorMap::replace(int number, const EdgeRaw2D &edge) {
    MapEdge &known = edges_[static_cast<std::size_t>(number)];
    take(known, edge, known.observations);
}

template <typename Place, typename Size>
const std::vector<int> &VectorMap::find(const Place &place, const Size &size) {
    found_.clear();
    grid_.query(place, size, [this](int number) {
        if (edges_[static_cast<std::size_t>(number)].observations > 0)
            found_.push_back(number);
    });
    std::sort(found_.begin(), found_.end());
    return found_;
}

VECTORLIB_BODY bool VectorMap::join(int number, int other) {
    MapEdge &a = edges_[static_cast<std::size_t>(number)];
    const MapEdge &b = edges_[static_cast<std::size_t>(other)];
    const LineSegment2D<double> &s = a.segment, &o = b.segment;
    if (s.direction().dot(o.direction()) < std::cos(settings.joinAngle))
        return false;
    const double t0 = s.along(o.begin()), t1 = s.along(o.end());
    if (std::max(t0, t1) < -settings.joinGap || std::min(t0, t1) > s.length() + settings.joinGap)
        return false;
    if (std::abs(s.across(o.begin())) > settings.joinDistance ||
        std::abs(s.across(o.end())) > settings.joinDistance)
        return false;
    const EdgeRaw2D joint = merged(a, b);
    if (joint.sigma > settings.maxSigma)
        return false;
    take(a, joint, std::max(a.observations, b.observations));
    remove(other);
    return true;
}

VECTORLIB_BODY void VectorMap::take(MapEdge &edge, const EdgeRaw2D &joint, std::int64_t observations) {
    static_cast<EdgeRaw2D &>(edge) = joint;
    edge.observations = observations;
    grid_.insert(static_cast<int>(edge.id), joint.segment);
    changed_.push_back(static_cast<int>(edge.id));
}

} // namespace vectorlib
