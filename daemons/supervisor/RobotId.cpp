#include "daemons/supervisor/RobotId.h"

#include "common/Log.h"
#include "common/OwnRobot.h"
#include "common/Project.h"
#include "common/files/Folder.h"
#include "common/files/NamedFile.h"
#include "common/files/SavedFile.h"
#include "common/interface/InterfaceUrl.h"

#include <QFileInfo>
#include <QUuid>
#include <optional>

namespace hermes::supervisor {
namespace {

constexpr qint64 maxIdBytes = 100;

/// Empty: none.
QString idFile(const QJsonArray &listen) {
    std::optional<quint16> first;
    for (const QJsonValue &address : listen) {
        const auto url = InterfaceUrl::parse(address.toString());
        if (!url || (url->scheme != "tcp" && url->scheme != "tls" && url->scheme != "udp"))
            continue;
        if (url->port == defaultPort("supervisor"))
            return "robot-id";
        first = first.value_or(url->port);
    }
    if (!first)
        return "robot-id";
    return *first == 0 ? QString() : QString("robot-id-%1").arg(*first);
}

} // namespace

QString newRobotId() {
    return QUuid::createUuid().toString(QUuid::WithoutBraces);
}

Result<QString> robotId(const QJsonArray &listen) {
    const QString name = idFile(listen), path = stateFolder() + '/' + name;
    if (name.isEmpty())
        return newRobotId();
    if (QFileInfo::exists(path)) {
        const Result<QByteArray> read = readNamedFile(path, {stateFolder()}, maxIdBytes);
        if (!read)
            return read.error();
        if (const QString id = QString::fromUtf8(read->trimmed()).toLower(); isRobotId(id))
            return id;
        logWarning("robot", path + " has no id of a robot: it gets a new one");
    }
    const QString id = newRobotId();
    if (const Result<void> made = makeFolder(stateFolder()); !made)
        return made.error();
    if (const Result<void> saved = saveFile(path, id.toUtf8() + '\n'); !saved)
        return saved.error();
    return id;
}

} // namespace hermes::supervisor
