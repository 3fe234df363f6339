#pragma once

#include "protocol/wire/FieldTable.h"
#include "protocol/wire/FieldsOf.h"

#include <QJsonArray>
#include <QMap>
#include <QStringList>
#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace hermes {

/// The table of a struct, made once.
template <typename T>
const Fields<T> &fieldsOf() {
    static const Fields<T> made = fieldsOf(Of<T>());
    return made;
}

/// Of structs with fields.
template <typename T, typename>
struct Type {
    static void write(WireWriter &out, const T &value) { fieldsOf<T>().write(out, &value); }
    static void read(WireView in, T &value, const Limits &, ReadReport &report) {
        fieldsOf<T>().read(in, &value, report);
    }
    static QJsonObject schema(const Limits &) { return fieldsOf<T>().schema(); }
};

/// Numbers, checked against their limits.
double readNumber(WireView in, Limits limits, ReadReport &report);
qint64 readInteger(WireView in, Limits limits, ReadReport &report);
QJsonObject numberSchema(const char *type, const Limits &limits);

/// And no more than the type T can hold.
template <typename T>
Limits limitsOf(Limits limits) {
    limits.least = std::max(limits.least, double(std::numeric_limits<T>::lowest()));
    limits.most = std::min(limits.most, double(std::numeric_limits<T>::max()));
    return limits;
}

template <typename T>
struct Type<T, std::enable_if_t<std::is_floating_point_v<T>>> {
    static void write(WireWriter &out, T value) { out.number(value); }
    static void read(WireView in, T &value, const Limits &limits, ReadReport &report) {
        value = T(readNumber(in, limitsOf<T>(limits), report));
    }
    static QJsonObject schema(const Limits &limits) { return numberSchema("number", limits); }
};

template <typename T>
struct Type<T, std::enable_if_t<std::is_integral_v<T> && !std::is_same_v<T, bool>>> {
    static void write(WireWriter &out, T value) { out.integer(qint64(value)); }
    static void read(WireView in, T &value, const Limits &limits, ReadReport &report) {
        value = T(readInteger(in, limitsOf<T>(limits), report));
    }
    /// Tells what small numbers can hold; for others it is beyond interest.
    static QJsonObject schema(Limits limits) {
        if (sizeof(T) < sizeof(int))
            limits = limitsOf<T>(limits);
        else if (std::is_unsigned_v<T>)
            limits.least = std::max(limits.least, 0.0);
        return numberSchema("integer", limits);
    }
};

template <>
struct Type<bool> {
    static void write(WireWriter &out, bool value) { out.boolean(value); }
    static void read(WireView in, bool &value, const Limits &, ReadReport &report);
    static QJsonObject schema(const Limits &);
};

template <>
struct Type<QString> {
    static void write(WireWriter &out, const QString &value) { out.text(value); }
    static void read(WireView in, QString &value, const Limits &, ReadReport &report);
    static QJsonObject schema(const Limits &);
};

template <>
struct Type<std::string> {
    static void write(WireWriter &out, const std::string &value) { out.text(QString::fromStdString(value)); }
    static void read(WireView in, std::string &value, const Limits &limits, ReadReport &report);
    static QJsonObject schema(const Limits &limits) { return Type<QString>::schema(limits); }
};

/// Null where there is none. In a field, which is left out where there is none, a std::optional of it.
template <typename T>
struct Type<std::optional<T>> {
    static void write(WireWriter &out, const std::optional<T> &value) {
        value ? Type<T>::write(out, *value) : out.null();
    }
    static void read(WireView in, std::optional<T> &value, const Limits &limits, ReadReport &report) {
        value.reset();
        if (in.kind() != WireView::Kind::Null)
            Type<T>::read(in, value.emplace(), limits, report);
    }
    static QJsonObject schema(const Limits &limits) { return orNull(Type<T>::schema(limits)); }
};

/// Open: any JSON value.
template <>
struct Type<QJsonValue> {
    static void write(WireWriter &out, const QJsonValue &value) { out.json(value); }
    static void read(WireView in, QJsonValue &value, const Limits &, ReadReport &) { value = in.toJson(); }
    static QJsonObject schema(const Limits &);
};

/// Open: an object with any members.
template <>
struct Type<QJsonObject> {
    static void write(WireWriter &out, const QJsonObject &value) { out.json(value); }
    static void read(WireView in, QJsonObject &value, const Limits &, ReadReport &report);
    static QJsonObject schema(const Limits &);
};

bool readsAsArray(WireView in, std::size_t least, std::size_t most, ReadReport &report);
/// Without an upper bound where it is that of all arrays.
QJsonObject arraySchema(const QJsonObject &items, std::size_t least, std::size_t most);

/// What the lists below share.
template <typename List, typename T>
struct ListType {
    static constexpr bool isPacked =
        std::is_floating_point_v<T> || std::is_same_v<T, quint8> || std::is_same_v<T, quint16>;

    static void write(WireWriter &out, const List &values) {
        if constexpr (isPacked)
            return out.numbers(values.data(), std::size_t(values.size()));
        out.beginArray();
        std::size_t i = 0;
        for (const T &value : values) {
            Type<T>::write(out, value);
            if (out.hasRefused())
                return out.within(QString::number(i));
            ++i;
        }
        out.endArray();
    }

    static void readElements(WireView in, List &values, const Limits &limits, ReadReport &report) {
        std::size_t first = 0;
        if constexpr (isPacked) { // many at once; what is wrong is looked at one by one
            const Limits within = limitsOf<T>(limits);
            const std::size_t count = in.numbers(values.data());
            while (first < count && double(values[first]) >= within.least &&
                   double(values[first]) <= within.most)
                ++first;
        }
        for (std::size_t i = first; i < in.size(); ++i) {
            Type<T>::read(in[i], values[i], limits, report);
            if (report.hasFailed())
                return report.within(QString::number(i));
        }
    }
};

template <typename T>
struct Type<std::vector<T>> : ListType<std::vector<T>, T> {
    static void read(WireView in, std::vector<T> &values, const Limits &limits, ReadReport &report) {
        if (!readsAsArray(in, 0, limits.elements, report))
            return;
        values.resize(in.size());
        ListType<std::vector<T>, T>::readElements(in, values, limits, report);
    }
    static QJsonObject schema(const Limits &limits) {
        return arraySchema(Type<T>::schema(limits), 0, limits.elements);
    }
};

template <typename T, std::size_t N>
struct Type<std::array<T, N>> : ListType<std::array<T, N>, T> {
    static void read(WireView in, std::array<T, N> &values, const Limits &limits, ReadReport &report) {
        if (readsAsArray(in, N, N, report))
            ListType<std::array<T, N>, T>::readElements(in, values, limits, report);
    }
    static QJsonObject schema(const Limits &limits) { return arraySchema(Type<T>::schema(limits), N, N); }
};

template <>
struct Type<QStringList> {
    static void write(WireWriter &out, const QStringList &values);
    static void read(WireView in, QStringList &values, const Limits &limits, ReadReport &report);
    static QJsonObject schema(const Limits &limits);
};

/// An object whose members have names that are not known beforehand.
template <typename T>
struct Type<QMap<QString, T>> {
    static void write(WireWriter &out, const QMap<QString, T> &values) {
        out.beginObject();
        for (auto value = values.begin(); value != values.end(); ++value) {
            out.key(value.key());
            Type<T>::write(out, value.value());
            if (out.hasRefused())
                return out.within(value.key());
        }
        out.endObject();
    }
    static void read(WireView in, QMap<QString, T> &values, const Limits &limits, ReadReport &report) {
        if (in.kind() != WireView::Kind::Object)
            return report.fail(in, QStringLiteral("an object"));
        in.forEachMember([&](const QString &name, WireView value) {
            if (report.hasFailed())
                return;
            Type<T>::read(value, values[name], limits, report);
            if (report.hasFailed())
                report.within(name);
        });
    }
    static QJsonObject schema(const Limits &limits) {
        return {{QStringLiteral("type"), QStringLiteral("object")},
                {QStringLiteral("additionalProperties"), Type<T>::schema(limits)}};
    }
};

/// Of members of the type M.
template <typename M>
inline constexpr MemberType memberType{
    nullptr,
    [](WireWriter &out, const void *member) { Type<M>::write(out, *static_cast<const M *>(member)); },
    [](WireView in, void *member, const Limits &limits, ReadReport &report) {
        Type<M>::read(in, *static_cast<M *>(member), limits, report);
    },
    [](const Limits &limits) { return Type<M>::schema(limits); }};

/// Of members that may be empty: their value, where there is one.
template <typename M>
inline constexpr MemberType memberType<std::optional<M>>{
    [](const void *member) { return !static_cast<const std::optional<M> *>(member)->has_value(); },
    [](WireWriter &out, const void *member) {
        Type<M>::write(out, **static_cast<const std::optional<M> *>(member));
    },
    [](WireView in, void *member, const Limits &limits, ReadReport &report) {
        Type<M>::read(in, static_cast<std::optional<M> *>(member)->emplace(), limits, report);
    },
    [](const Limits &limits) { return Type<M>::schema(limits); }};

} // namespace hermes
