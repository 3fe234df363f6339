#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace hermes::ros {

/// Names a message's type. Beside each message M stands `constexpr auto tableOf(Of<M>)`, its fields in the
/// order of the wire. Bytes, text and hash all come from this table.
template <typename M>
struct Of {};

/// ROS's `byte`: eight bits that are no number.
enum class Octet : std::uint8_t {};

template <typename M, typename T>
struct Field {
    const char *name;
    T M::*member;
};
template <typename M, typename T>
constexpr Field<M, T> field(const char *name, T M::*member) {
    return {name, member};
}

/// type: as ROS 2 writes it, "sensor_msgs/msg/LaserScan".
template <typename... Members>
struct Table {
    const char *type;
    std::tuple<Members...> members;
};
template <typename... Members>
constexpr Table<Members...> table(const char *type, Members... members) {
    return {type, std::tuple<Members...>(members...)};
}

/// Calls f(name, value) for each field of the message, in the order of the wire.
template <typename M, typename F>
void forEachField(M &message, F &&f) {
    std::apply([&](const auto &...member) { (f(member.name, message.*member.member), ...); },
               tableOf(Of<std::remove_const_t<M>>()).members);
}

template <typename M>
constexpr const char *typeOf() {
    return tableOf(Of<M>()).type;
}

/// Such a message is one byte.
template <typename M>
constexpr bool hasNoFields = std::tuple_size_v<decltype(tableOf(Of<M>()).members)> == 0;

/// A number, bool or Octet: its bytes are those of the wire.
template <typename T>
constexpr bool isPlain = std::is_arithmetic_v<T> || std::is_same_v<T, Octet>;

template <typename T>
struct Elements {
    using Element = void; ///< of no array
};
template <typename T>
struct Elements<std::vector<T>> {
    using Element = T;
};
template <typename T, std::size_t n>
struct Elements<std::array<T, n>> {
    using Element = T;
};

} // namespace hermes::ros
