#pragma once

#include <QJsonObject>
#include <QStringList>

namespace hermes::ctl {

/// What a daemon tells of itself, looked up by names. OpenRPC description, schema of settings.
QStringList namesOf(const QJsonArray &list);
/// The one of that name; empty where there is none.
QJsonObject named(const QJsonArray &list, const QString &name);
/// The schema of all parameters of a method as one object.
QJsonObject parametersSchema(const QJsonObject &method);
/// The schema of a setting, or of a group of settings, by its dotted path.
QJsonObject settingSchema(const QJsonObject &schema, const QString &path);
/// The dotted paths of all settings; with groups: of what holds settings, too.
QStringList settingPaths(const QJsonObject &schema, bool withGroups);
/// "one of "C", "K"; default "C"; Of the result".
QString explanation(const QJsonObject &schema);

} // namespace hermes::ctl
