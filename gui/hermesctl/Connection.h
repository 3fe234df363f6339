#pragma once

#include "common/client/Client.h"

#include <QEventLoop>
#include <memory>

namespace hermes::ctl {

/// Connects, with one attempt; remembers the host for completion. Error: who did not answer and why.
Result<void> connectOnce(Client &client, const QString &address, std::chrono::milliseconds timeout);

/// Connects to all at the same time, with one attempt each. Who did not answer has no connection, and a
/// lastError() unless the time was up.
std::vector<std::unique_ptr<Client>> connectAll(const QStringList &addresses,
                                                std::chrono::milliseconds timeout);

/// Calls a method of all at the same time; the replies are in their order. Who is nullptr is not called, and
/// has the error Disconnected.
std::vector<Result<QJsonValue>> callAllAndWait(const std::vector<Client *> &clients, const QString &method,
                                               std::chrono::milliseconds timeout);

} // namespace hermes::ctl
