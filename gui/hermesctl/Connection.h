#pragma once

#include "gui/session/SessionMember.h"

#include <QEventLoop>
#include <memory>
#include <optional>

namespace hermes::ctl {

/// Connects, with one attempt; remembers the host for completion. Error: who did not answer and why.
Result<void> connectOnce(Client &client, const QString &address, std::chrono::milliseconds timeout);

/// Connects to all at the same time, with one attempt each. Who did not answer has no connection, and a
/// lastError() unless the time was up.
std::vector<std::unique_ptr<Client>> connectAll(const QStringList &addresses,
                                                std::chrono::milliseconds timeout);

/// Begins something, and waits in a nested event loop for what it gives: begin takes a function to give it
/// to.
template <typename T, typename Begin>
T await(const Begin &begin) {
    std::optional<T> result;
    QEventLoop loop;
    begin([&](const T &value) {
        result = value;
        loop.quit();
    });
    if (!result)
        loop.exec();
    return *result;
}

/// As callAll, and waits.
SessionReplies callAllAndWait(const std::vector<SessionCall> &calls, const QString &method,
                              std::chrono::milliseconds timeout);

} // namespace hermes::ctl
