#include "gui/hermesctl/WrongItems.h"

namespace hermes::ctl {

QJsonArray wrongItems(const SessionReply &status) {
    QJsonArray wrong;
    if (!status.result)
        return wrong;
    for (const QJsonValue &item : (*status.result)[QStringLiteral("health")].toArray())
        if (item[QStringLiteral("level")] != QStringLiteral("ok"))
            wrong.append(QJsonObject{{QStringLiteral("name"), item[QStringLiteral("name")]},
                                     {QStringLiteral("level"), item[QStringLiteral("level")]},
                                     {QStringLiteral("message"), item[QStringLiteral("message")]}});
    return wrong;
}

QString wrongText(const QJsonValue &item) {
    return QStringLiteral("%1: %2: %3")
        .arg(item[QStringLiteral("level")].toString(), item[QStringLiteral("name")].toString(),
             item[QStringLiteral("message")].toString());
}

} // namespace hermes::ctl
