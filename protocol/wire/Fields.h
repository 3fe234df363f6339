#pragma once

#include "protocol/wire/JsonWriters.h"
#include "protocol/wire/Types.h"

#include <memory>

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
        FieldTable::add(name, offsetOf(member), memberType<M>, description, unit);
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

    /// The fields of Part, a member, beside the others.
    template <typename Part, typename Owner>
    Fields &include(Part Owner::*member) {
        FieldTable::include(fieldsOf<Part>(), offsetOf(member));
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

private:
    template <typename M, typename Owner>
    static std::size_t offsetOf(M Owner::*member) {
        const union Place { // of a T that is never made
            char begin;
            T message;
            Place()
                : begin(0) {}
            ~Place() {}
        } place;
        return std::size_t(reinterpret_cast<const char *>(std::addressof(place.message.*member)) -
                           &place.begin);
    }
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
