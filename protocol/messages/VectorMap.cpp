#include "protocol/messages/VectorMap.h"
#include "protocol/wire/Fields.h"

namespace hermes {

Fields<GraphLoop> fieldsOf(Of<GraphLoop>) {
    return Fields<GraphLoop>()
        .add("from", &GraphLoop::from, "Number of the earlier key scan")
        .add("to", &GraphLoop::to, "Number of the later one")
        .add("weight", &GraphLoop::weight,
             "How far the poses believe it, 0 to 1; below 0.25 the drive and other loops contradict it");
}

Fields<GraphMessage> fieldsOf(Of<GraphMessage>) {
    return Fields<GraphMessage>()
        .add("revision", &GraphMessage::revision, "Counts these messages")
        .add("cleared", &GraphMessage::cleared,
             "What was known of the graph is void: this is the whole, or its first part")
        .add("first", &GraphMessage::first, "Number of the first key scan of poses")
        .add("poses", &GraphMessage::poses, "Of key scans, in the map's frame: x, y (m), theta (rad)")
        .add("trust", &GraphMessage::trust, "Of each of these poses, as in the topic pose")
        .add("loops", &GraphMessage::loops, "That were found with these key scans, as the later ones")
        .add("size", &GraphMessage::size, "Key scans of the graph after this message");
}

Fields<MapEdgeMessage> fieldsOf(Of<MapEdgeMessage>) {
    return Fields<MapEdgeMessage>()
        .add("id", &MapEdgeMessage::id, "As long as the edge is in the map")
        .range(0, 9007199254740992.0)
        .add("x1", &MapEdgeMessage::x1, "Beginning; free space lies on the left", "m")
        .add("y1", &MapEdgeMessage::y1, "Beginning", "m")
        .add("x2", &MapEdgeMessage::x2, "End", "m")
        .add("y2", &MapEdgeMessage::y2, "End", "m")
        .addMaybe("n", &MapEdgeMessage::n, "Points that lie on it")
        .addMaybe("sigma", &MapEdgeMessage::sigma, "Deviation of the points from the line", "m")
        .addMaybe("observations", &MapEdgeMessage::observations, "Scans that saw it");
}

Fields<MapMessage> fieldsOf(Of<MapMessage>) {
    return Fields<MapMessage>()
        .add("revision", &MapMessage::revision, "Counts the changes of the map")
        .add("cleared", &MapMessage::cleared,
             "What was known of the map is void: this is the whole map, or its first part")
        .add("edges", &MapMessage::edges, "New and altered ones")
        .add("removed", &MapMessage::removed, "Ids of edges that are there no more")
        .add("size", &MapMessage::size, "Edges of the map after this change")
        .addMaybe("map", &MapMessage::map,
                  "Which map it is: another one has another number, a corrected one keeps its own, and so "
                  "does the live map that a replay has set aside");
}

} // namespace hermes
