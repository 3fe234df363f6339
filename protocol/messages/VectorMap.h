#pragma once

#include "protocol/wire/FieldsOf.h"

#include <QtGlobal>

#include <array>
#include <vector>

namespace hermes {

/// A place that was met again: the numbers of two key scans that were matched with each other.
struct GraphLoop {
    qint64 from = 0, to = 0;
    double weight = 0;
};

/// The topic `graph`: how the matcher put the drive together; new key scans, or all of them, in parts where
/// they are many.
struct GraphMessage {
    qint64 revision = 0;
    bool cleared = false;
    qint64 first = 0;
    std::vector<std::array<double, 3>> poses;
    std::vector<double> trust;
    std::vector<GraphLoop> loops;
    qint64 size = 0;
};

Fields<GraphLoop> fieldsOf(Of<GraphLoop>);
Fields<GraphMessage> fieldsOf(Of<GraphMessage>);

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

Fields<MapEdgeMessage> fieldsOf(Of<MapEdgeMessage>);
Fields<MapMessage> fieldsOf(Of<MapMessage>);

} // namespace hermes
