#pragma once

#include "protocol/wire/WireValue.h"
#include "protocol/wire/WireWriter.h"

#include <QJsonArray>
#include <QJsonObject>
#include <QString>
#include <limits>
#include <vector>

namespace hermes {

/// What a reader of messages found wrong first, and how much it did not know.
struct ReadReport {
    QString path;        ///< dotted, of the member that is wrong; empty: the message itself
    QString found;       ///< in its place
    QString expected;    ///< empty: nothing is wrong
    quint64 unknown = 0; ///< members that the reader does not know: of a newer program, left alone

    bool hasFailed() const { return !expected.isEmpty(); }
    void fail(WireView value, const QString &wanted) {
        found = value.described();
        expected = wanted;
    }
    /// Whoever read a member or an element that is wrong says which.
    void within(const QString &name) { path = path.isEmpty() ? name : name + QLatin1Char('.') + path; }
    /// "member pose.x: found text "a", expected a number"
    QString text() const {
        return QStringLiteral("%1: found %2, expected %3")
            .arg(path.isEmpty() ? QStringLiteral("message") : QStringLiteral("member ") + path, found,
                 expected);
    }
};

/// What numbers a field may hold, and how many elements.
struct Limits {
    double least = -std::numeric_limits<double>::max();
    double most = std::numeric_limits<double>::max();
    std::size_t elements = 10000000;
};

/// A schema that allows null too.
QJsonObject orNull(QJsonObject schema);

/// Of an object that has these members and no others.
QJsonObject objectSchema(const QJsonObject &properties, const QJsonArray &required);

/// How a member of a struct is written, read and described. One for all members of a type.
struct MemberType {
    bool (*isEmpty)(const void *member); ///< null: it always has a value
    void (*write)(WireWriter &out, const void *member);
    void (*read)(WireView in, void *member, const Limits &limits, ReadReport &report);
    QJsonObject (*schema)(const Limits &limits);
};

/// How the fields of a struct are named on the wire and what they mean: writing, checked reading and the JSON
/// Schema follow from it. Made by Fields<T>.
class FieldTable {
public:
    void write(WireWriter &out, const void *message) const;
    /// What it does not find stays as it is. Fields that are unknown are counted and left alone.
    void read(WireView in, void *message, ReadReport &report) const;
    /// With `additionalProperties: false`.
    QJsonObject schema() const;

protected:
    struct Entry {
        QByteArray name;
        std::size_t offset; ///< in the struct, bytes
        const MemberType *type;
        Limits limits = {};
        QJsonObject keywords = {}; ///< description, unit ...
        bool isNullable = false;   ///< empty: null instead of left out
        bool mayBeMissing = false;

        bool isOptional() const { return type->isEmpty; }
        const void *of(const void *message) const { return static_cast<const char *>(message) + offset; }
        void *of(void *message) const { return static_cast<char *>(message) + offset; }
    };

    void add(const char *name, std::size_t offset, const MemberType &type, const char *description,
             const char *unit);
    /// The fields of a part of the struct, which lies there.
    void include(const FieldTable &part, std::size_t offset);
    static QJsonObject schemaOf(const Entry &entry);

    std::vector<Entry> entries_;
};

} // namespace hermes
