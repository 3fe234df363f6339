#include "daemons/scanmatcher/MapMirror.h"

namespace hermes {

namespace {

QJsonObject toJson(const vectorlib::MapEdge &m) {
    return {{"id", qint64(m.id)},        {"x1", m.segment.begin().x},
            {"y1", m.segment.begin().y}, {"x2", m.segment.end().x},
            {"y2", m.segment.end().y},   {"n", m.sums.n},
            {"sigma", m.sigma},          {"observations", qint64(m.observations)}};
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

void MapMirror::replace(Edges &other) {
    edges.swap(other);
    poses.clear();
    ++revision;
}

QJsonObject MapMirror::apply(const MapChanges &changes) {
    QJsonArray changed, removed;
    for (const vectorlib::MapEdge &m : changes.changed) {
        edges[m.id] = m;
        changed.append(toJson(m));
    }
    for (qint64 id : changes.removed) {
        edges.erase(id);
        removed.append(id);
    }
    return {{"revision", ++revision},
            {"cleared", false},
            {"edges", changed},
            {"removed", removed},
            {"size", qint64(edges.size())}};
}

QJsonObject MapMirror::full() const {
    QJsonArray all;
    for (const auto &[id, edge] : edges)
        all.append(toJson(edge));
    return {{"revision", revision},
            {"cleared", true},
            {"edges", all},
            {"removed", QJsonArray()},
            {"size", qint64(edges.size())}};
}

QJsonObject MapMirror::part(qint64 &cursor) const {
    const bool isFirst = cursor == 0;
    QJsonArray some;
    auto edge = edges.lower_bound(cursor);
    for (; edge != edges.end() && some.size() < partEdges; ++edge)
        some.append(toJson(edge->second));
    cursor = edge == edges.end() ? -1 : edge->first;
    return {{"revision", revision},
            {"cleared", isFirst},
            {"edges", some},
            {"removed", QJsonArray()},
            {"size", qint64(edges.size())}};
}

} // namespace hermes
