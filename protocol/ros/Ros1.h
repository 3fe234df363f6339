#pragma once

#include "protocol/ros/Bytes.h"

namespace hermes::ros {

/// The bytes of the message in a bag of ROS 1.
template <typename M>
std::string toRos1(const M &message) {
    std::string out;
    Writer<Form::Ros1>(out).write(message);
    return out;
}

template <typename M>
Outcome<M> fromRos1(std::string_view bytes) {
    Reader<Form::Ros1> in(bytes);
    M message;
    in.read(message);
    if (in.hasFailed())
        return std::string(typeOf<M>()) + ": " + in.problem();
    if (const std::size_t rest = bytes.size() - in.position(); rest != 0)
        return std::string(typeOf<M>()) + ": " + std::to_string(rest) + " bytes too many";
    return message;
}

} // namespace hermes::ros
