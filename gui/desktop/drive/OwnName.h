#pragma once

#include <QHostInfo>
#include <QString>

namespace hermes::desktop {

/// What this program calls itself to others: "hermes-gui of USER on HOST".
inline QString ownName() {
    const QString user = qEnvironmentVariable("USER", qEnvironmentVariable("LOGNAME"));
    return "hermes-gui " + (user.isEmpty() ? QString() : "of " + user.left(30) + ' ') + "on " +
           QHostInfo::localHostName().left(40);
}

} // namespace hermes::desktop
