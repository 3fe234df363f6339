#pragma once

#include "common/client/Client.h"

#include <QStringList>
#include <memory>
#include <vector>

namespace hermes {

/// Connects, with one attempt. Error: who did not answer and why.
Result<void> connectOnce(Client &client, const QString &address, std::chrono::milliseconds timeout);

/// Connects to all at the same time, with one attempt each. Who did not answer has no connection, and a
/// lastError() unless the time was up.
std::vector<std::unique_ptr<Client>> connectAll(const QStringList &addresses,
                                                std::chrono::milliseconds timeout);

/// A client and the parameters that a method is called with.
using ClientCall = std::pair<Client *, QJsonObject>;

/// Calls a method of each at the same time; gives each its result, in the order of the calls.
std::vector<Result<QJsonValue>> callAll(const std::vector<ClientCall> &calls, const QString &method,
                                        std::chrono::milliseconds timeout);

} // namespace hermes
