#include "gui/hermesctl/WrongItems.h"

namespace hermes::ctl {

QJsonArray wrongItems(const SessionReply &status) {
    QJsonArray wrong;
    if (!status.result)
        return wrong;
    for (const QJsonValue &item : (*status.result)["health"].toArray())
        if (item["level"] != "ok")
            wrong.append(
                QJsonObject{{"name", item["name"]}, {"level", item["level"]}, {"message", item["message"]}});
    return wrong;
}

QString wrongText(const QJsonValue &item) {
    return QString("%1: %2: %3")
        .arg(item["level"].toString(), item["name"].toString(), item["message"].toString());
}

} // namespace hermes::ctl
