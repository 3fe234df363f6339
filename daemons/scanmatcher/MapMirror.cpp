#include "daemons/scanmatcher/MapMirror.h"
#include "vectorlib/io/Number.h"

namespace hermes::scanmatcher {

GraphMessage GraphMirror::grow(GraphMessage &&more) {
    all_.poses.insert(all_.poses.end(), more.poses.begin(), more.poses.end());
    all_.trust.insert(all_.trust.end(), more.trust.begin(), more.trust.end());
    all_.loops.insert(all_.loops.end(), more.loops.begin(), more.loops.end());
    all_.size = more.size;
    more.revision = ++all_.revision;
    return std::move(more);
}

GraphMessage GraphMirror::part(qint64 &cursor) const {
    GraphMessage some;
    some.revision = all_.revision;
    some.cleared = cursor == 0;
    cursor = std::min(cursor, qint64(all_.poses.size()));
    some.first = cursor;
    some.size = all_.size;
    const qint64 end = std::min(cursor + partKeys, qint64(all_.poses.size()));
    some.poses.assign(all_.poses.begin() + cursor, all_.poses.begin() + end);
    some.trust.assign(all_.trust.begin() + cursor, all_.trust.begin() + end);
    // Loops are in the order of their later key scans.
    const auto isBefore = [](const GraphLoop &loop, qint64 key) { return loop.to < key; };
    const auto begin = std::lower_bound(all_.loops.begin(), all_.loops.end(), cursor, isBefore);
    some.loops.assign(begin, std::lower_bound(begin, all_.loops.end(), end, isBefore));
    cursor = end == qint64(all_.poses.size()) ? -1 : end;
    return some;
}

namespace {

// As exact as in a file (writeMapCsv).
MapEdgeMessage messageOf(const vectorlib::MapEdge &m) {
    using vectorlib::micrometres;
    const auto &s = m.segment;
    return {qint64(m.id),           micrometres(s.begin().x), micrometres(s.begin().y),
            micrometres(s.end().x), micrometres(s.end().y),   double(m.sums.n),
            micrometres(m.sigma),   qint64(m.observations)};
}

} // namespace

MapChanges takeChanges(vectorlib::VectorMap &map) {
    MapChanges changes;
    for (int number : map.takeChanges()) {
        const vectorlib::MapEdge &e = map.slots()[size_t(number)];
        if (e.observations > 0)
            changes.changed.push_back(e);
        else
            changes.removed.push_back(e.id);
    }
    return changes;
}

void MapMirror::replace(Edges &other, qint64 number) {
    edges_.swap(other);
    number_ = number;
    isSaved_ = false;
    poses_.clear();
    ++revision_;
}

void MapMirror::correct(Edges &other, const std::vector<quint64> &numbers,
                        const std::vector<vectorlib::Pose2D> &poses) {
    edges_.swap(other);
    isSaved_ = false;
    ++revision_;
    vectorlib::Transformation2D moved;
    auto number = numbers.begin();
    for (quint64 i = numbers.empty() ? poses_.size() : numbers.front(); i < poses_.size(); ++i) {
        vectorlib::Pose2D &pose = poses_[i].pose;
        const vectorlib::Transformation2D was(pose);
        if (number != numbers.end() && *number == i) {
            pose = poses[size_t(number - numbers.begin())];
            moved = vectorlib::Transformation2D(pose) * was.inverse();
            ++number;
        } else {
            pose = (moved * was).pose();
        }
    }
}

MapMessage MapMirror::message(bool cleared) const {
    return {revision_, cleared, {}, {}, qint64(edges_.size()), number_};
}

MapMessage MapMirror::apply(const MapChanges &changes) {
    ++revision_;
    isSaved_ = false;
    for (const vectorlib::MapEdge &m : changes.changed)
        edges_[m.id] = m;
    for (qint64 id : changes.removed)
        edges_.erase(id);
    MapMessage told = message(false);
    for (const vectorlib::MapEdge &m : changes.changed)
        told.edges.push_back(messageOf(m));
    told.removed = changes.removed;
    return told;
}

MapMessage MapMirror::full() const {
    MapMessage all = message(true);
    for (const auto &[id, edge] : edges_)
        all.edges.push_back(messageOf(edge));
    return all;
}

MapMessage MapMirror::part(qint64 &cursor) const {
    MapMessage some = message(cursor == 0);
    auto edge = edges_.lower_bound(cursor);
    for (; edge != edges_.end() && some.edges.size() < partEdges; ++edge)
        some.edges.push_back(messageOf(edge->second));
    cursor = edge == edges_.end() ? -1 : edge->first;
    return some;
}

} // namespace hermes::scanmatcher
