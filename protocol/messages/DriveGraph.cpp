#include "protocol/messages/DriveGraph.h"

#include "protocol/wire/Fields.h"

namespace hermes {

const Fields<GraphLoop> &fieldsOf(Of<GraphLoop>) {
    static const auto fields =
        Fields<GraphLoop>()
            .add("from", &GraphLoop::from, "Number of the earlier key scan")
            .add("to", &GraphLoop::to, "Number of the later one")
            .add("weight", &GraphLoop::weight,
                 "How far the poses believe it, 0 to 1; below 0.25 the drive and other loops contradict it");
    return fields;
}

const Fields<GraphMessage> &fieldsOf(Of<GraphMessage>) {
    static const auto fields =
        Fields<GraphMessage>()
            .add("revision", &GraphMessage::revision, "Counts these messages")
            .add("cleared", &GraphMessage::cleared,
                 "What was known of the graph is void: this is the whole, or its first part")
            .add("first", &GraphMessage::first, "Number of the first key scan of poses")
            .add("poses", &GraphMessage::poses, "Of key scans, in the map's frame: x, y (m), theta (rad)")
            .add("trust", &GraphMessage::trust, "Of each of these poses, as in the topic pose")
            .add("loops", &GraphMessage::loops, "That were found with these key scans, as the later ones")
            .add("size", &GraphMessage::size, "Key scans of the graph after this message");
    return fields;
}

} // namespace hermes
