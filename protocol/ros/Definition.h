#pragma once

#include "protocol/ros/Table.h"

#include <map>

namespace hermes::ros {

/// A field of a message, by text.
struct Member {
    std::string name;
    std::string type; ///< "float64", "string", or a message: "std_msgs/msg/Header"
    bool isSequence = false;
    std::size_t length = 0; ///< of an array; 0: it is none
};

/// The messages that one is made of, itself among them, by their types: "sensor_msgs/msg/LaserScan".
using Members = std::map<std::string, std::vector<Member>>;

/// Its fields as the text of a .msg, then those of the messages in it: what MCAP and bags call its
/// definition.
std::string definitionText(const std::string &type, const Members &members);

/// The text whose SHA-256 is the type's hash, "RIHS01_" in front. Source: REP 2016.
std::string hashedText(const std::string &type, const Members &members);

/// "sensor_msgs::msg::dds_::LaserScan_".
std::string ddsType(const std::string &type);

template <typename T>
std::string nameOf() {
    if constexpr (std::is_same_v<T, bool>)
        return "bool";
    else if constexpr (std::is_same_v<T, Octet>)
        return "byte";
    else if constexpr (std::is_same_v<T, std::string>)
        return "string";
    else if constexpr (std::is_floating_point_v<T>)
        return sizeof(T) == 4 ? "float32" : "float64";
    else if constexpr (std::is_integral_v<T>)
        return (std::is_unsigned_v<T> ? "uint" : "int") + std::to_string(8 * sizeof(T));
    else
        return typeOf<T>();
}

template <typename M>
void describe(Members &members);

template <typename T>
Member describeMember(const char *name, const T &value, Members &members) {
    using Element = typename Elements<T>::Element;
    Member member{name, {}, std::is_same_v<T, std::vector<Element>>, 0};
    if constexpr (std::is_void_v<Element>) {
        member.type = nameOf<T>();
        if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string>)
            describe<T>(members);
    } else {
        member.type = nameOf<Element>();
        member.length = member.isSequence ? 0 : value.size();
        if constexpr (std::is_class_v<Element> && !std::is_same_v<Element, std::string>)
            describe<Element>(members);
    }
    return member;
}

template <typename M>
void describe(Members &members) {
    if (members.count(typeOf<M>()) != 0)
        return;
    std::vector<Member> own;
    M message;
    forEachField(message, [&](const char *name, const auto &value) {
        own.push_back(describeMember(name, value, members));
    });
    members[typeOf<M>()] = own;
}

/// Of the message M.
template <typename M>
std::string definitionOf() {
    Members members;
    describe<M>(members);
    return definitionText(typeOf<M>(), members);
}
template <typename M>
std::string hashedTextOf() {
    Members members;
    describe<M>(members);
    return hashedText(typeOf<M>(), members);
}

} // namespace hermes::ros
