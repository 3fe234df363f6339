#pragma once

#include "protocol/wire/FieldsOf.h"

#include <QtGlobal>
#include <vector>

namespace hermes {

/// An edge of the vector map: free space on its left.
struct MapEdgeMessage {
    qint64 id = 0;
    double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
    double n = 0;
    double sigma = 0;
    qint64 observations = 0;
};

/// The topic `map`, and what map.get gives: changes, or the whole map, in parts where it is large.
struct MapMessage {
    qint64 revision = 0;
    bool cleared = false;
    std::vector<MapEdgeMessage> edges;
    std::vector<qint64> removed;
    qint64 size = 0;
    qint64 map = 0;
};

const Fields<MapEdgeMessage> &fieldsOf(Of<MapEdgeMessage>);
const Fields<MapMessage> &fieldsOf(Of<MapMessage>);

} // namespace hermes
