#pragma once

#include "common/Result.h"

#include <QString>

namespace hermes {

/// Where a daemon listens that a person names: "motorcontrol" means its default port on the host, "HOST:PORT"
/// and URLs stand for themselves. InvalidParams: a name that is not known.
Result<QString> daemonAddress(const QString &word, const QString &host = QStringLiteral("127.0.0.1"));

/// The same address, for a program of a person: a daemon of the same user is reached over its Unix socket,
/// with all rights (OwnSocket.h).
QString asOwner(const QString &address);

/// Whether a client can connect to HOST:PORT or a URL. InvalidParams: what was expected.
Result<void> checkAddress(const QString &address);

} // namespace hermes
