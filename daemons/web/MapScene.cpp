#include "daemons/web/MapScene.h"

#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"

namespace hermes::web {
namespace {

constexpr qint64 idsOfPart = 500;
constexpr double thickness = 2; // pixels

QJsonObject pointJson(double x, double y) {
    return {{"x", x}, {"y", y}, {"z", 0}};
}

} // namespace

QByteArray MapScene::take(const Origin &origin, ReadReport &report) {
    const auto message = readMessage<MapMessage>(origin.update.data, report);
    if (!message)
        return {};
    stamp_ = origin.update.stamp;
    if (message->cleared) {
        isCleared_ = true;
        parts_.clear();
        changed_.clear();
    }
    for (const MapEdgeMessage &edge : message->edges) {
        parts_[edge.id / idsOfPart][edge.id] = edge;
        changed_.insert(edge.id / idsOfPart);
    }
    for (const qint64 id : message->removed) {
        const auto part = parts_.find(id / idsOfPart);
        if (part == parts_.end())
            continue;
        part->second.erase(id);
        changed_.insert(part->first);
    }
    return {};
}

QByteArray MapScene::due() {
    if (!isCleared_ && changed_.empty())
        return {};
    QJsonArray deletions, entities;
    if (std::exchange(isCleared_, false))
        deletions.append(QJsonObject{{"timestamp", timeJson(stamp_)}, {"type", 1}, {"id", ""}});
    for (const qint64 part : std::exchange(changed_, {}))
        entities.append(entity(part));
    return compactJson(QJsonObject{{"deletions", deletions}, {"entities", entities}});
}

QJsonObject MapScene::entity(qint64 part) const {
    QJsonArray points;
    for (const auto &[id, edge] : parts_.at(part)) {
        points.append(pointJson(edge.x1, edge.y1));
        points.append(pointJson(edge.x2, edge.y2));
    }
    const QJsonObject lines{{"type", 2}, // each two points
                            {"pose", poseJson({})},
                            {"thickness", thickness},
                            {"scale_invariant", true},
                            {"points", points},
                            {"color", QJsonObject{{"r", 0.2}, {"g", 0.6}, {"b", 1}, {"a", 1}}},
                            {"colors", QJsonArray()},
                            {"indices", QJsonArray()}};
    QJsonObject made{{"timestamp", timeJson(stamp_)},
                     {"frame_id", "map"},
                     {"id", QString("edges from %1").arg(part * idsOfPart)},
                     {"lifetime", timeJson(0)},
                     {"frame_locked", true},
                     {"lines", QJsonArray{lines}}};
    for (const char *none :
         {"metadata", "arrows", "cubes", "spheres", "cylinders", "triangles", "texts", "models"})
        made[QLatin1String(none)] = QJsonArray();
    return made;
}

} // namespace hermes::web
