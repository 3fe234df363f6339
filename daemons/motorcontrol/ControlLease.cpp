#include "daemons/motorcontrol/ControlLease.h"

#include <QJsonObject>
#include <algorithm>

namespace hermes::motorcontrol {

Error ControlLease::heldByAnother() const {
    return Error(ErrorCode::ControlHeld, QString("%1 holds the control").arg(holder_->name),
                 QJsonObject{{"holder", holder_->name}});
}

Result<void> ControlLease::acquire(quint64 client, const QString &name, double timeout_s, double now) {
    if (holder_ && holder_->client != client)
        return heldByAnother();
    const auto wanted = holder_ ? holder_->wanted : std::nullopt;
    holder_ = Holder{client, name, timeout_s, now + timeout_s, wanted};
    return {};
}

std::optional<QString> ControlLease::takeOver(quint64 client, const QString &name, double timeout_s,
                                              double now) {
    std::optional<QString> loser;
    if (holder_ && holder_->client != client)
        loser = holder_->name;
    holder_ = Holder{client, name, timeout_s, now + timeout_s, std::nullopt};
    return loser;
}

Result<void> ControlLease::renew(quint64 client, double now) {
    if (!holder_)
        return Error(ErrorCode::ControlHeld,
                     "this client does not hold the control; control.acquire gives it",
                     QJsonObject{{"holder", QJsonValue::Null}});
    if (holder_->client != client)
        return heldByAnother();
    holder_->until = now + holder_->timeout_s;
    return {};
}

void ControlLease::ask(quint64 client, const QString &name) {
    if (holder_ && holder_->client != client)
        holder_->wanted = name;
}

bool ControlLease::release(quint64 client) {
    const bool held = isHeldBy(client);
    if (held)
        holder_.reset();
    return held;
}

std::optional<QString> ControlLease::expire(double now) {
    if (!holder_ || now < holder_->until)
        return std::nullopt;
    const QString name = holder_->name;
    holder_.reset();
    return name;
}

LeaseState ControlLease::state(double now) const {
    if (!holder_)
        return {};
    return {true, holder_->name, std::max(0.0, holder_->until - now), holder_->wanted};
}

} // namespace hermes::motorcontrol
