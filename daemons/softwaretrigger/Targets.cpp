#include "daemons/softwaretrigger/Targets.h"

#include "common/Log.h"
#include "common/client/DaemonAddress.h"

namespace hermes::softwaretrigger {

void Targets::use(const QSet<QString> &daemons) {
    for (auto target = targets_.begin(); target != targets_.end();) {
        if (daemons.contains(target->first)) {
            ++target;
            continue;
        }
        const Target gone = std::move(target->second);
        target = targets_.erase(target);
        gone.client->close(); // its calls fail now
    }
    for (const QString &daemon : daemons) {
        if (targets_.count(daemon) != 0)
            continue;
        Target target{std::make_unique<Client>(), std::make_shared<int>(0)};
        const auto address = daemonAddress(daemon);
        const auto begun = address ? target.client->connectTo(*address) : Result<void>(address.error());
        if (!begun)
            logWarning("targets", daemon + ": " + begun.error().message);
        targets_.emplace(daemon, std::move(target));
    }
}

void Targets::call(const QString &daemon, const QString &method, const QJsonObject &params, double timeout_s,
                   const Client::Callback &done) {
    const auto found = targets_.find(daemon);
    if (found == targets_.end())
        return done(Error(ErrorCode::NotReady, daemon + " is no longer a target"));
    const std::shared_ptr<int> waiting = found->second.waiting;
    if (*waiting >= maxCalls)
        return done(Error(ErrorCode::OverLimit,
                          QString("%1: %2 calls wait for its replies already").arg(daemon).arg(*waiting)));
    ++*waiting;
    found->second.client->call(
        method, params,
        [waiting, done](const Result<QJsonValue> &result) {
            --*waiting;
            done(result);
        },
        std::chrono::milliseconds(qint64(timeout_s * 1000)));
}

QJsonObject Targets::toJson() const {
    QJsonObject result;
    for (const auto &[daemon, target] : targets_)
        result.insert(daemon, QJsonObject{{"connected", target.client->isConnected()},
                                          {"error", target.client->lastError()},
                                          {"waiting", *target.waiting}});
    return result;
}

QStringList Targets::unreachable() const {
    QStringList result;
    for (const auto &[daemon, target] : targets_) {
        if (!target.client->isConnected() && !target.client->isBeginning())
            result.append(daemon);
    }
    return result;
}

} // namespace hermes::softwaretrigger
