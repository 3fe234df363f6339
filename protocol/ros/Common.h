#pragma once

#include "protocol/ros/Table.h"

namespace hermes::ros {

// The messages of std_msgs, geometry_msgs and builtin_interfaces that others are made of. Lengths in m,
// angles in rad. The fields are those of ROS 2 Humble and Jazzy; where ROS 1 has the message, its fields are
// the same.

struct Time {
    std::int32_t sec = 0;
    std::uint32_t nanosec = 0;
};
constexpr auto tableOf(Of<Time>) {
    return table("builtin_interfaces/msg/Time", field("sec", &Time::sec), field("nanosec", &Time::nanosec));
}

struct Duration {
    std::int32_t sec = 0;
    std::uint32_t nanosec = 0;
};
constexpr auto tableOf(Of<Duration>) {
    return table("builtin_interfaces/msg/Duration", field("sec", &Duration::sec),
                 field("nanosec", &Duration::nanosec));
}

struct Header {
    Time stamp;
    std::string frameId;
};
constexpr auto tableOf(Of<Header>) {
    return table("std_msgs/msg/Header", field("stamp", &Header::stamp), field("frame_id", &Header::frameId));
}

struct String {
    std::string data;
};
constexpr auto tableOf(Of<String>) {
    return table("std_msgs/msg/String", field("data", &String::data));
}

struct Bool {
    bool data = false;
};
constexpr auto tableOf(Of<Bool>) {
    return table("std_msgs/msg/Bool", field("data", &Bool::data));
}

/// Each from 0 to 1.
struct Color {
    float r = 0, g = 0, b = 0, a = 1;
};
constexpr auto tableOf(Of<Color>) {
    return table("std_msgs/msg/ColorRGBA", field("r", &Color::r), field("g", &Color::g),
                 field("b", &Color::b), field("a", &Color::a));
}

struct Point {
    double x = 0, y = 0, z = 0;
};
constexpr auto tableOf(Of<Point>) {
    return table("geometry_msgs/msg/Point", field("x", &Point::x), field("y", &Point::y),
                 field("z", &Point::z));
}

struct Vector3 {
    double x = 0, y = 0, z = 0;
};
constexpr auto tableOf(Of<Vector3>) {
    return table("geometry_msgs/msg/Vector3", field("x", &Vector3::x), field("y", &Vector3::y),
                 field("z", &Vector3::z));
}

struct Quaternion {
    double x = 0, y = 0, z = 0, w = 1;
};
constexpr auto tableOf(Of<Quaternion>) {
    return table("geometry_msgs/msg/Quaternion", field("x", &Quaternion::x), field("y", &Quaternion::y),
                 field("z", &Quaternion::z), field("w", &Quaternion::w));
}

struct Pose {
    Point position;
    Quaternion orientation;
};
constexpr auto tableOf(Of<Pose>) {
    return table("geometry_msgs/msg/Pose", field("position", &Pose::position),
                 field("orientation", &Pose::orientation));
}

struct PoseStamped {
    Header header;
    Pose pose;
};
constexpr auto tableOf(Of<PoseStamped>) {
    return table("geometry_msgs/msg/PoseStamped", field("header", &PoseStamped::header),
                 field("pose", &PoseStamped::pose));
}

/// Row by row; x, y, z and the rotations about them (m^2, m rad, rad^2).
using Covariance6 = std::array<double, 36>;

struct PoseWithCovariance {
    Pose pose;
    Covariance6 covariance{};
};
constexpr auto tableOf(Of<PoseWithCovariance>) {
    return table("geometry_msgs/msg/PoseWithCovariance", field("pose", &PoseWithCovariance::pose),
                 field("covariance", &PoseWithCovariance::covariance));
}

struct PoseWithCovarianceStamped {
    Header header;
    PoseWithCovariance pose;
};
constexpr auto tableOf(Of<PoseWithCovarianceStamped>) {
    return table("geometry_msgs/msg/PoseWithCovarianceStamped",
                 field("header", &PoseWithCovarianceStamped::header),
                 field("pose", &PoseWithCovarianceStamped::pose));
}

/// m/s and rad/s.
struct Twist {
    Vector3 linear, angular;
};
constexpr auto tableOf(Of<Twist>) {
    return table("geometry_msgs/msg/Twist", field("linear", &Twist::linear),
                 field("angular", &Twist::angular));
}

struct TwistStamped {
    Header header;
    Twist twist;
};
constexpr auto tableOf(Of<TwistStamped>) {
    return table("geometry_msgs/msg/TwistStamped", field("header", &TwistStamped::header),
                 field("twist", &TwistStamped::twist));
}

struct TwistWithCovariance {
    Twist twist;
    Covariance6 covariance{};
};
constexpr auto tableOf(Of<TwistWithCovariance>) {
    return table("geometry_msgs/msg/TwistWithCovariance", field("twist", &TwistWithCovariance::twist),
                 field("covariance", &TwistWithCovariance::covariance));
}

/// Of the child's frame in its parent's.
struct Transform {
    Vector3 translation;
    Quaternion rotation;
};
constexpr auto tableOf(Of<Transform>) {
    return table("geometry_msgs/msg/Transform", field("translation", &Transform::translation),
                 field("rotation", &Transform::rotation));
}

struct TransformStamped {
    Header header; ///< of the parent's frame
    std::string childFrameId;
    Transform transform;
};
constexpr auto tableOf(Of<TransformStamped>) {
    return table("geometry_msgs/msg/TransformStamped", field("header", &TransformStamped::header),
                 field("child_frame_id", &TransformStamped::childFrameId),
                 field("transform", &TransformStamped::transform));
}

} // namespace hermes::ros
