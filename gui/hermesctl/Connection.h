#pragma once

#include "common/client/Client.h"

#include <QString>

namespace hermes {

/// Connects, with one attempt. Error: who did not answer and why.
Result<void> connectOnce(Client &client, const QString &address, std::chrono::milliseconds timeout);

} // namespace hermes
