#pragma once

#include <QJsonObject>
#include <QString>

namespace hermes::ctl {

/// The reference of a daemon in Markdown, from its description (OpenRPC) and the schema of its settings.
QString descriptionAsMarkdown(const QJsonObject &description, const QJsonObject &settingsSchema);

/// The same for a terminal, one line a method and topic.
QString descriptionAsText(const QJsonObject &description);

} // namespace hermes::ctl
