#pragma once

#include "common/client/Client.h"

#include <QSet>
#include <map>
#include <memory>

namespace hermes::softwaretrigger {

/// Connections to the daemons that triggers name, one each; they connect again by themselves, and none waits
/// for another.
class Targets {
public:
    /// Calls of one daemon that may wait for their replies; one more fails at once.
    static constexpr int maxCalls = 64;

    /// Connects to what is named here and not connected yet, ends what is not named.
    void use(const QSet<QString> &daemons);
    void close() { targets_.clear(); }

    /// done is called once: with the result, or why there is none (at the latest after the timeout).
    void call(const QString &daemon, const QString &method, const QJsonObject &params, double timeout_s,
              const Client::Callback &done);
    /// One that use() has named.
    Client &client(const QString &daemon) { return *targets_.at(daemon).client; }

    /// Of each: connected, the last error, calls that wait.
    QJsonObject toJson() const;
    QStringList unreachable() const;

private:
    struct Target {
        std::unique_ptr<Client> client;
        std::shared_ptr<int> waiting; // calls; outlives the target in their callbacks
    };
    std::map<QString, Target> targets_;
};

} // namespace hermes::softwaretrigger
