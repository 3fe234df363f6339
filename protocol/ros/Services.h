#pragma once

#include "protocol/ros/Messages.h"

namespace hermes::ros {

/// std_srvs/srv/Trigger.
struct TriggerRequest {};
constexpr auto tableOf(Of<TriggerRequest>) {
    return table("std_srvs/srv/Trigger_Request");
}

struct TriggerResponse {
    bool success = false;
    std::string message;
};
constexpr auto tableOf(Of<TriggerResponse>) {
    return table("std_srvs/srv/Trigger_Response", field("success", &TriggerResponse::success),
                 field("message", &TriggerResponse::message));
}

/// nav_msgs/srv/GetMap.
struct GetMapRequest {};
constexpr auto tableOf(Of<GetMapRequest>) {
    return table("nav_msgs/srv/GetMap_Request");
}

struct GetMapResponse {
    OccupancyGrid map;
};
constexpr auto tableOf(Of<GetMapResponse>) {
    return table("nav_msgs/srv/GetMap_Response", field("map", &GetMapResponse::map));
}

/// What rmw_cyclonedds puts before each request and its reply: whose it is, and which.
template <typename M>
struct Numbered {
    std::uint64_t client = 0;
    std::int64_t number = 0;
    M body;
};
template <typename M>
constexpr auto tableOf(Of<Numbered<M>>) {
    return table(typeOf<M>(), field("client", &Numbered<M>::client), field("number", &Numbered<M>::number),
                 field("body", &Numbered<M>::body));
}

} // namespace hermes::ros
