#pragma once

#include "protocol/wire/WireValue.h"
#include "protocol/wire/WireWriter.h"

#include <QJsonArray>
#include <QJsonObject>
#include <QString>
#include <functional>
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
        Limits limits;
        QJsonObject keywords; ///< description, unit ...
        bool isOptional = false;
        bool isNullable = false; ///< empty: null instead of left out
        bool mayBeMissing = false;
        void describe(const char *description, const char *unit) {
            keywords.insert(QStringLiteral("description"), QString::fromUtf8(description));
            if (*unit)
                keywords.insert(QStringLiteral("unit"), QString::fromUtf8(unit));
        }

        std::function<bool(const void *message)> isEmpty; ///< of an optional one
        std::function<void(WireWriter &out, const void *message)> write;
        std::function<void(WireView in, void *message, const Limits &limits, ReadReport &report)> read;
        std::function<QJsonObject(const Limits &limits)> schema;
    };

    static QJsonObject schemaOf(const Entry &entry);

    std::vector<Entry> entries_;
};

} // namespace hermes
