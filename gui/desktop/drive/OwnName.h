#pragma once

#include "gui/desktop/model/DaemonLink.h"

#include <QHostInfo>
#include <QString>

namespace hermes::desktop {

/// What this program calls itself to others: "hermes-gui of USER on HOST".
inline QString ownName() {
    const QString user = qEnvironmentVariable("USER", qEnvironmentVariable("LOGNAME"));
    return "hermes-gui " + (user.isEmpty() ? QString() : "of " + user.left(30) + ' ') + "on " +
           QHostInfo::localHostName().left(40);
}

/// The parameters of a method with that name, where the daemon is known to take it: it would refuse the rest,
/// and with it a stop.
inline QJsonObject ownNameFor(const DaemonLink *daemon, const QString &method) {
    return daemon && daemon->takes(method, "client") ? QJsonObject{{"client", ownName()}} : QJsonObject();
}
} // namespace hermes::desktop
