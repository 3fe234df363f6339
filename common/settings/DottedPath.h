#pragma once

#include <QJsonObject>
#include <QString>

namespace hermes {

/// The value at "motor.wheel.radius" in nested objects; undefined where there is none. "" is the whole.
QJsonValue valueAt(const QJsonObject &object, const QString &path);

/// The object with that value in place, objects made on the way.
QJsonObject withValueAt(const QJsonObject &object, const QString &path, const QJsonValue &value);

/// Both merged: objects member by member, every other value of changes replaces that of base.
QJsonObject merged(const QJsonObject &base, const QJsonObject &changes);

/// What is in object and not equal in base, as a partial object.
QJsonObject difference(const QJsonObject &object, const QJsonObject &base);

/// The dotted paths of all values that are not objects.
QStringList leafPaths(const QJsonObject &object, const QString &prefix = QString());

} // namespace hermes
