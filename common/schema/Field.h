#pragma once

#include <QJsonArray>
#include <QJsonObject>
#include <QString>

namespace hermes {

/// The declaration of one value, be it a parameter of a command or a setting: its JSON Schema with type,
/// unit, limits, default and description. Written as a chain:
/// `Field::number("vx", "Speed ahead").unit("m/s").range(-1, 1).byDefault(0)`.
class Field {
public:
    static Field number(const QString &name, const QString &description);
    static Field integer(const QString &name, const QString &description);
    /// A number of radians, of a full turn at most.
    static Field angle(const QString &name, const QString &description);
    static Field text(const QString &name, const QString &description);
    static Field boolean(const QString &name, const QString &description);
    /// itemSchema: the JSON Schema of each element, e.g. {{"type", "number"}}.
    static Field array(const QString &name, const QString &description, const QJsonObject &itemSchema);
    /// With any members.
    static Field object(const QString &name, const QString &description);
    /// Any JSON value.
    static Field any(const QString &name, const QString &description);
    /// With a JSON Schema of one's own.
    static Field schema(const QString &name, const QString &description, const QJsonObject &schema);

    Field &title(const QString &text);
    Field &unit(const QString &text);
    Field &minimum(double value);
    Field &maximum(double value);
    Field &range(double least, double most);
    Field &step(double increment);
    Field &choices(const QStringList &allowed);
    /// The value where none is given; also makes a parameter optional.
    Field &byDefault(const QJsonValue &value);
    /// A parameter that may be absent without having a default.
    Field &optional();
    /// Settings: under which heading a user interface shows it.
    Field &group(const QString &name);
    /// Settings: a change has effect after the next start only.
    Field &appliesOnRestart();
    /// Any further keyword of the schema.
    Field &with(const QString &keyword, const QJsonValue &value);

    const QString &name() const { return fieldName_; }
    const QJsonObject &schema() const { return content_; }
    bool isRequired() const { return required_; }
    QJsonValue defaultValue() const { return content_.value(QStringLiteral("default")); }

private:
    Field(QString name, const QString &description, QJsonObject schema);

    QString fieldName_;
    QJsonObject content_;
    bool required_ = true;
};

} // namespace hermes
