#pragma once

#include <QHash>
#include <QJsonObject>
#include <QMap>
#include <QStringList>
#include <optional>

namespace hermes::ctl {

/// The messages of a topic as lines of CSV (RFC 4180, lines end with LF). A column for each value: those of
/// inner objects by their path; a list of fixed, small length has a column for each element, any other list
/// is one field of JSON. The columns are those of the schema; where it leaves open what an object holds,
/// those of the first message.
class CsvTable {
public:
    explicit CsvTable(const QJsonObject &schema);

    /// With units as in "x [m]"; nothing while the columns depend on a message that has not come.
    std::optional<QString> header() const;
    /// Fixes the columns where they are not.
    void begin(const QJsonValue &first);
    QString line(const QString &stamp, quint64 seq, quint64 dropped, const QJsonValue &data);

    /// Values that came after the header and have no column: path, in how many messages.
    const QMap<QString, quint64> &withoutColumn() const { return withoutColumn_; }

private:
    struct Column {
        QString path;
        QString unit;
        bool open = false; ///< what it holds is not known as yet
    };

    void addColumns(const QJsonObject &schema, const QString &path);
    void addProperties(const QJsonObject &schema, const QString &path);
    void addVariants(const QJsonArray &variants, const QString &path);
    void add(const Column &column);
    bool isFixed() const;
    void flatten(const QJsonValue &value, const QString &path, QMap<QString, QJsonValue> &fields) const;

    QList<Column> columns_;
    QHash<QString, int> places_;  ///< of paths among the columns
    QMap<QString, int> elements_; ///< lists with a column for each element: how many
    QMap<QString, quint64> withoutColumn_;
};

/// A field in quotes where it needs them.
QString csvField(const QString &text);

} // namespace hermes::ctl
