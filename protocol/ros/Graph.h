#pragma once

#include "protocol/ros/Table.h"

namespace hermes::ros {

/// The id of an endpoint in `ros_discovery_info`: 24 bytes in Humble, 16 since Iron; what DDS does not fill
/// is 0.
template <std::size_t bytes>
struct Gid {
    std::array<std::uint8_t, bytes> data{};
};
template <std::size_t bytes>
constexpr auto tableOf(Of<Gid<bytes>>) {
    return table("rmw_dds_common/msg/Gid", field("data", &Gid<bytes>::data));
}

template <std::size_t bytes>
struct NodeEntities {
    std::string space, name;
    std::vector<Gid<bytes>> readers, writers;
};
template <std::size_t bytes>
constexpr auto tableOf(Of<NodeEntities<bytes>>) {
    using M = NodeEntities<bytes>;
    return table("rmw_dds_common/msg/NodeEntitiesInfo", field("node_namespace", &M::space),
                 field("node_name", &M::name), field("reader_gid_seq", &M::readers),
                 field("writer_gid_seq", &M::writers));
}

/// The topic `ros_discovery_info`: the nodes of a participant.
template <std::size_t bytes>
struct ParticipantEntities {
    Gid<bytes> participant;
    std::vector<NodeEntities<bytes>> nodes;
};
template <std::size_t bytes>
constexpr auto tableOf(Of<ParticipantEntities<bytes>>) {
    using M = ParticipantEntities<bytes>;
    return table("rmw_dds_common/msg/ParticipantEntitiesInfo", field("gid", &M::participant),
                 field("node_entities_info_seq", &M::nodes));
}

} // namespace hermes::ros
