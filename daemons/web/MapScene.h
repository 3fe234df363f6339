#pragma once

#include "daemons/web/Views.h"
#include "protocol/messages/VectorMap.h"

#include <map>
#include <set>

namespace hermes::web {

/// foxglove.SceneUpdate of the vector map: lines of its edges. Of a large map only the parts that changed are
/// sent: an entity has the edges whose ids are near each other.
class MapScene : public View {
public:
    QByteArray take(const Origin &origin, ReadReport &report) override;
    QByteArray due() override;

private:
    using Edges = std::map<qint64, MapEdgeMessage>; // by id

    QJsonObject entity(qint64 part) const;

    std::map<qint64, Edges> parts_;
    std::set<qint64> changed_; ///< parts
    bool isCleared_ = false;
    double stamp_ = 0;
};

} // namespace hermes::web
