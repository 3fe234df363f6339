#pragma once

#include "protocol/wire/JsonWriters.h"
#include "protocol/wire/Types.h"

#include <array>

namespace hermes {

/// The fields of the struct T, one add() after another, each followed by what is to be said of it:
///
///     Fields<Twist2D> fieldsOf(Of<Twist2D>) {
///         return Fields<Twist2D>()
///             .add("vx", &Twist2D::vx, "Forward", "m/s")
///             .add("omega", &Twist2D::omega, "Counter-clockwise", "rad/s");
///     }
///
/// A std::optional may be absent on the wire.
template <typename T>
class Fields : public FieldTable {
public:
    template <typename M, typename Owner>
    Fields &add(const char *name, M Owner::*member, const char *description, const char *unit = "") {
        using Value = typename Unwrapped<M>::Type;
        Entry entry;
        entry.name = name;
        entry.describe(description, unit);
        entry.write = [member](WireWriter &out, const void *message) {
            Type<Value>::write(out, Unwrapped<M>::value(static_cast<const T *>(message)->*member));
        };
        entry.read = [member](WireView in, void *message, const Limits &limits, ReadReport &report) {
            Type<Value>::read(in, Unwrapped<M>::make(static_cast<T *>(message)->*member), limits, report);
        };
        entry.schema = [](const Limits &limits) { return Type<Value>::schema(limits); };
        if constexpr (Unwrapped<M>::isOptional) {
            entry.isOptional = true;
            entry.isEmpty = [member](const void *message) {
                return !(static_cast<const T *>(message)->*member).has_value();
            };
        }
        entries_.push_back(std::move(entry));
        return *this;
    }

    /// One that is null on the wire, not absent, where it is empty.
    template <typename Member>
    Fields &addOrNull(const char *name, Member member, const char *description, const char *unit = "") {
        return add(name, member, description, unit).orNull();
    }
    /// One that a reader does without, and leaves as it is; a writer always writes it.
    template <typename Member>
    Fields &addMaybe(const char *name, Member member, const char *description, const char *unit = "") {
        return add(name, member, description, unit).mayBeMissing();
    }

    /// The elements of an array, each under a name of its own.
    template <typename M, std::size_t N, typename Owner>
    Fields &addEach(const std::array<const char *, N> &names, std::array<M, N> Owner::*member,
                    const char *description, const char *unit = "") {
        for (std::size_t i = 0; i < N; ++i) {
            Entry entry;
            entry.name = names[i];
            entry.describe(description, unit);
            entry.write = [member, i](WireWriter &out, const void *message) {
                Type<M>::write(out, (static_cast<const T *>(message)->*member)[i]);
            };
            entry.read = [member, i](WireView in, void *message, const Limits &limits, ReadReport &report) {
                Type<M>::read(in, (static_cast<T *>(message)->*member)[i], limits, report);
            };
            entry.schema = [](const Limits &limits) { return Type<M>::schema(limits); };
            entries_.push_back(std::move(entry));
        }
        return *this;
    }

    /// The fields of Part, a member, beside the others.
    template <typename Part, typename Owner>
    Fields &include(Part Owner::*member) {
        for (FieldTable::Entry entry : fieldsOf<Part>().entries_) {
            entry.write = [member, inner = entry.write](WireWriter &out, const void *message) {
                inner(out, &(static_cast<const T *>(message)->*member));
            };
            entry.read = [member, inner = entry.read](WireView in, void *message, const Limits &limits,
                                                      ReadReport &report) {
                inner(in, &(static_cast<T *>(message)->*member), limits, report);
            };
            if (entry.isEmpty)
                entry.isEmpty = [member, inner = entry.isEmpty](const void *message) {
                    return inner(&(static_cast<const T *>(message)->*member));
                };
            entries_.push_back(std::move(entry));
        }
        return *this;
    }

    Fields &range(double least, double most) {
        entries_.back().limits.least = least;
        entries_.back().limits.most = most;
        return *this;
    }
    Fields &atMostElements(std::size_t count) {
        entries_.back().limits.elements = count;
        return *this;
    }
    Fields &choices(const QStringList &allowed) { return with("enum", QJsonArray::fromStringList(allowed)); }
    /// As addMaybe() and addOrNull() do.
    Fields &mayBeMissing() {
        entries_.back().mayBeMissing = true;
        return *this;
    }
    Fields &orNull() {
        entries_.back().isNullable = true;
        return *this;
    }
    /// Any further keyword of the schema.
    Fields &with(const char *keyword, const QJsonValue &value) {
        entries_.back().keywords.insert(QLatin1String(keyword), value);
        return *this;
    }

    template <typename Other>
    friend class Fields;
};

/// As QJsonValue; undefined where a number is not finite.
template <typename T>
QJsonValue asJson(const T &value) {
    JsonValueWriter out;
    Type<T>::write(out, value);
    return out.hasRefused() ? QJsonValue(QJsonValue::Undefined) : out.value();
}

/// Checked: nothing where something is missing, of a wrong type, out of its range or not finite; report says
/// what, and counts fields that are unknown in any case.
template <typename T>
std::optional<T> readMessage(WireView in, ReadReport &report) {
    T message{};
    Type<T>::read(in, message, Limits(), report);
    return report.hasFailed() ? std::nullopt : std::optional<T>(std::move(message));
}

template <typename T>
QJsonObject schemaOf() {
    return Type<T>::schema(Limits());
}

} // namespace hermes
