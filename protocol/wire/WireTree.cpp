#include "protocol/wire/WireTree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace hermes {
namespace {

using Kind = PackedNumbers::Kind;

/// Calls f with a number of the type that the kind names.
template <typename F>
auto withType(Kind kind, const F &f) {
    switch (kind) {
    case Kind::UInt8:
        return f(quint8());
    case Kind::UInt16:
        return f(quint16());
    case Kind::UInt32:
        return f(quint32());
    case Kind::UInt64:
        return f(quint64());
    case Kind::Int8:
        return f(qint8());
    case Kind::Int16:
        return f(qint16());
    case Kind::Int32:
        return f(qint32());
    case Kind::Int64:
        return f(qint64());
    case Kind::Float:
        return f(float());
    case Kind::Double:
        break;
    }
    return f(double());
}

template <typename T>
T numberAt(const char *bytes, std::size_t i) {
    T value;
    std::memcpy(&value, bytes + i * sizeof(T), sizeof(T)); // they may lie anywhere
    return value;
}

/// Integers hold whole numbers only, and no more than they can.
template <typename To, typename From>
bool fits(From value) {
    if constexpr (std::is_floating_point_v<To>)
        return true;
    else
        return double(value) >= double(std::numeric_limits<To>::lowest()) &&
               double(value) <= double(std::numeric_limits<To>::max()) &&
               double(value) == std::floor(double(value));
}

} // namespace

std::size_t PackedNumbers::sizeOf(Kind kind) {
    return withType(kind, [](auto number) { return sizeof number; });
}

std::optional<PackedNumbers> PackedNumbers::of(const Node &node) {
    if (!node.IsObject() || node.MemberCount() != 1)
        return std::nullopt;
    const auto &member = *node.MemberBegin();
    const char *const name = member.name.GetString();
    if (std::less<>()(name, names) || !std::less<>()(name, names + sizeof names - 1))
        return std::nullopt;
    return PackedNumbers{Kind(name - names), member.value.GetString(), member.value.GetStringLength()};
}

double PackedNumbers::at(std::size_t i) const {
    return withType(kind, [this, i](auto number) { return double(numberAt<decltype(number)>(bytes, i)); });
}

std::optional<qint64> PackedNumbers::integer(std::size_t i) const {
    return withType(kind, [this, i](auto number) -> std::optional<qint64> {
        const auto value = numberAt<decltype(number)>(bytes, i);
        if constexpr (std::is_integral_v<decltype(number)> && sizeof(number) < sizeof(qint64))
            return qint64(value);
        if constexpr (std::is_same_v<decltype(number), qint64>)
            return value;
        if (double(value) == std::floor(double(value)) && std::abs(double(value)) < 9.2e18)
            return qint64(value);
        return std::nullopt;
    });
}

template <typename T>
std::size_t PackedNumbers::copy(T *to) const {
    return withType(kind, [this, to](auto number) {
        using From = decltype(number);
        const std::size_t count = size();
        if constexpr (std::is_same_v<From, T>) {
            if (count > 0) // else there may be no place either
                std::memcpy(to, bytes, count * sizeof(T));
            return count;
        } else {
            std::size_t i = 0;
            for (; i < count && fits<T>(numberAt<From>(bytes, i)); ++i)
                to[i] = T(numberAt<From>(bytes, i));
            return i;
        }
    });
}

template std::size_t PackedNumbers::copy(float *) const;
template std::size_t PackedNumbers::copy(double *) const;
template std::size_t PackedNumbers::copy(quint8 *) const;
template std::size_t PackedNumbers::copy(quint16 *) const;

bool TreeBuilder::Key(const char *text, unsigned length, bool copy) {
    if (!isWhole(text, length))
        return false;
    keys_.back().emplace_back(text, length);
    return document_.Key(text, length, copy);
}

bool TreeBuilder::packed(PackedNumbers::Kind kind, const char *bytes, unsigned byteCount) {
    return count() && document_.StartObject() && document_.Key(PackedNumbers::names + int(kind), 1, false) &&
           document_.String(bytes, byteCount, false) && document_.EndObject(1);
}

// The parser of JSON lets half of a pair of surrogates pass where it is the second one.
bool TreeBuilder::isWhole(const char *text, unsigned length) {
    const char *const end = text + length;
    for (const char *at = text; at != end; ++at) {
        at = static_cast<const char *>(std::memchr(at, 0xED, std::size_t(end - at)));
        if (!at)
            return true;
        if (end - at > 1 && static_cast<unsigned char>(at[1]) >= 0xA0) {
            complaint = QStringLiteral("half of a surrogate pair");
            return false;
        }
    }
    return true;
}

// Once each: arrays and objects, too.
bool TreeBuilder::count() {
    if (++values_ > limits_.values)
        complaint = QString("more than %1 values").arg(limits_.values);
    return complaint.isEmpty();
}

bool TreeBuilder::enter() {
    if (!count())
        return false;
    keys_.emplace_back();
    if (int(keys_.size()) > limits_.depth)
        complaint = QString("nested deeper than %1 levels").arg(limits_.depth);
    return complaint.isEmpty();
}

bool TreeBuilder::leave() {
    std::vector<std::string> &names = keys_.back();
    std::sort(names.begin(), names.end());
    const auto twice = std::adjacent_find(names.begin(), names.end());
    if (twice != names.end())
        complaint = QString("the key \"%1\" occurs twice in one object").arg(QString::fromStdString(*twice));
    keys_.pop_back();
    return complaint.isEmpty();
}

} // namespace hermes
