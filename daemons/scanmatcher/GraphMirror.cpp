#include "daemons/scanmatcher/GraphMirror.h"

#include <algorithm>

namespace hermes::scanmatcher {

void GraphMirror::replace(GraphMessage &&graph) {
    const qint64 revision = all_.revision + 1;
    all_ = std::move(graph);
    all_.revision = revision;
}

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

} // namespace hermes::scanmatcher
