#pragma once

#include <QJsonObject>
#include <QString>
#include <vector>

namespace hermes::ctl {

/// What a daemon tells of itself.
struct DaemonDescription {
    QString name;            ///< as in the program hermes-NAME
    QJsonObject description; ///< OpenRPC
    QJsonObject settings;    ///< JSON Schema
};

/// The reference of a daemon in Markdown, from its description (OpenRPC) and the schema of its settings.
QString descriptionAsMarkdown(const QJsonObject &description, const QJsonObject &settingsSchema);

/// The reference of several on one page, with a table of contents; what all have alike stands there once.
/// Without versions: it changes only with what they describe.
QString referenceAsMarkdown(const std::vector<DaemonDescription> &daemons);

/// The same for a terminal, one line a method and topic.
QString descriptionAsText(const QJsonObject &description);

/// The parts of a reference. heading: of the section, without "###".
QString methodSection(const QString &heading, const QJsonObject &method);
QString topicSection(const QString &heading, const QJsonObject &topic);
/// A line for each setting, but for those whose schema is the same in another one.
QString settingLines(const QJsonObject &schema, const QJsonObject &butFor = {}, const QString &prefix = {});
/// With these lines.
QString settingTable(const QString &lines);

} // namespace hermes::ctl
