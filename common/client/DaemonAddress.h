#pragma once

#include "common/Result.h"

#include <QString>

namespace hermes {

/// Where a daemon listens that a person names: "motorcontrol" means its default port on the host, "HOST:PORT"
/// and URLs stand for themselves. InvalidParams: a name that is not known.
Result<QString> daemonAddress(const QString &word, const QString &host = QStringLiteral("127.0.0.1"));

/// Whether a client can connect to HOST:PORT or a URL. InvalidParams: what was expected.
Result<void> checkAddress(const QString &address);

} // namespace hermes
