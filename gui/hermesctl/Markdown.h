#pragma once

#include <QJsonObject>
#include <QString>

namespace hermes::ctl {

/// The reference of a daemon in Markdown, from its description (OpenRPC) and the schema of its settings.
QString descriptionAsMarkdown(const QJsonObject &description, const QJsonObject &settingsSchema);

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
