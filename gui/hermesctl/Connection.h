#pragma once

#include "common/client/Client.h"

#include <QString>

namespace hermes {

/// The address that the word D of a command line means: a daemon's name (its default port on host),
/// HOST:PORT, or a URL. Error: a sentence that says what D may be.
Result<QString> resolveDaemon(const QString &word, const QString &host);

/// Connects, with one attempt. Error: who did not answer and why.
Result<void> connectOnce(Client &client, const QString &address, std::chrono::milliseconds timeout);

} // namespace hermes
