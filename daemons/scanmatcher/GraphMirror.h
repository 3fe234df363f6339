#pragma once

#include "protocol/messages/DriveGraph.h"

#include <cstddef>

namespace hermes::scanmatcher {

/// A copy of the drive's graph for the main thread: what subscriptions to `graph` begin with.
class GraphMirror {
public:
    void replace(GraphMessage &&graph);
    /// Takes new key scans in and gives the data of the topic.
    GraphMessage grow(GraphMessage &&more);
    /// At most partKeys key scans from the number `cursor` on, which moves behind them, or below 0 with the
    /// last; `cleared` is true in the first part, from 0 on.
    GraphMessage part(qint64 &cursor) const;
    static constexpr qint64 partKeys = 1000;

private:
    GraphMessage all_;
};

} // namespace hermes::scanmatcher
