#include "protocol/messages/VectorMap.h"

#include "protocol/wire/Fields.h"

namespace hermes {

const Fields<MapEdgeMessage> &fieldsOf(Of<MapEdgeMessage>) {
    static const auto fields =
        Fields<MapEdgeMessage>()
            .add("id", &MapEdgeMessage::id, "As long as the edge is in the map")
            .range(0, 9007199254740992.0)
            .add("x1", &MapEdgeMessage::x1, "Beginning; free space lies on the left", "m")
            .add("y1", &MapEdgeMessage::y1, "Beginning", "m")
            .add("x2", &MapEdgeMessage::x2, "End", "m")
            .add("y2", &MapEdgeMessage::y2, "End", "m")
            .add("n", &MapEdgeMessage::n, "Points that lie on it")
            .mayBeMissing()
            .add("sigma", &MapEdgeMessage::sigma, "Deviation of the points from the line", "m")
            .mayBeMissing()
            .add("observations", &MapEdgeMessage::observations, "Scans that saw it")
            .mayBeMissing();
    return fields;
}

const Fields<MapMessage> &fieldsOf(Of<MapMessage>) {
    static const auto fields =
        Fields<MapMessage>()
            .add("revision", &MapMessage::revision, "Counts the changes of the map")
            .add("cleared", &MapMessage::cleared,
                 "What was known of the map is void: this is the whole map, "
                 "or its first part")
            .add("edges", &MapMessage::edges, "New and altered ones")
            .add("removed", &MapMessage::removed, "Ids of edges that are there no more")
            .add("size", &MapMessage::size, "Edges of the map after this change")
            .add(
                "map", &MapMessage::map,
                "Which map it is: another one has another number, a corrected one keeps its own, and so does "
                "the live map that a replay has set aside")
            .mayBeMissing();
    return fields;
}

} // namespace hermes
