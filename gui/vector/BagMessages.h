#pragma once

#include "common/Outcome.h"
#include "protocol/bag/Reader.h"
#include "protocol/ros/Cdr.h"
#include "protocol/ros/Definition.h"
#include "protocol/ros/Messages.h"
#include "protocol/ros/Ros1.h"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

namespace hermes::vector {

/// Names of the fields of the first type in a definition: neither constants nor types below it.
inline std::vector<std::string> fieldNames(const std::string &definition) {
    std::vector<std::string> names;
    std::istringstream lines(definition);
    for (std::string line; std::getline(lines, line);) {
        const bool isRule = line.rfind("====", 0) == 0;
        if (isRule && !names.empty())
            break;
        if (isRule || line.rfind("MSG:", 0) == 0) // some writers begin so
            continue;
        std::istringstream words(line.substr(0, line.find('#')));
        std::string type, name;
        if (words >> type >> name && line.substr(0, line.find('#')).find('=') == std::string::npos)
            names.push_back(name);
    }
    return names;
}

template <typename M>
bool isOfType(const bag::Topic &topic) {
    return topic.type == bag::plainType(ros::typeOf<M>());
}

/// Why messages of a topic that has the type's name are not read; empty: they are.
template <typename M>
std::string faultOf(const bag::Topic &topic) {
    if (topic.serialization != "ros1" && topic.serialization != "cdr")
        return "topic " + topic.name + ": found the serialization " + topic.serialization +
               ", expected ros1 or cdr";
    ros::Members members;
    ros::describe<M>(members);
    std::vector<std::string> expected;
    for (const ros::Member &member : members.at(ros::typeOf<M>()))
        expected.push_back(member.name);
    return topic.definition.empty() || fieldNames(topic.definition) == expected
               ? std::string()
               : "topic " + topic.name + ": its " + topic.type + " has other fields than those of ROS";
}

/// Of frames, and not refused.
inline bool isFrames(const bag::Topic &topic) {
    return (isOfType<ros::TfMessage>(topic) || topic.type == "tf/tfMessage") &&
           faultOf<ros::TfMessage>(topic).empty();
}
inline bool isOdometry(const bag::Topic &topic) {
    return topic.messages > 0 && isOfType<ros::Odometry>(topic);
}

template <typename M>
Outcome<M> messageFrom(const bag::Topic &topic, std::string_view data) {
    return topic.serialization == "ros1" ? ros::fromRos1<M>(data) : ros::fromCdr<M>(data);
}

/// Seconds.
inline double secondsOf(const ros::Time &time) {
    return double(time.sec) + 1e-9 * double(time.nanosec);
}

/// ROS 1 wrote some frames with a slash in front.
inline std::string plainFrame(const std::string &frame) {
    return frame.substr(std::min(frame.find_first_not_of('/'), frame.size()));
}

} // namespace hermes::vector
