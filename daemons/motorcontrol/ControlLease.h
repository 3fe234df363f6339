#pragma once

#include "common/Result.h"
#include "protocol/messages/Motors.h"

#include <optional>

namespace hermes::motorcontrol {

/// Who may move the robot: one client at a time, until it gives that back, goes away, or sends no motion
/// command for the time that it asked for. Times are seconds of a clock that never jumps.
class ControlLease {
public:
    /// Gives the control to a client, or renews what it holds. ControlHeld: another one has it.
    Result<void> acquire(quint64 client, const QString &name, double timeout_s, double now);
    /// The same, from whoever holds it; gives the name of the client that loses it.
    std::optional<QString> takeOver(quint64 client, const QString &name, double timeout_s, double now);
    /// A motion command of that client. ControlHeld, with data.holder, when it may not: null: nobody holds
    /// it.
    Result<void> renew(quint64 client, double now);
    /// Tells the holder that another client would like to have it: state().wanted, until it changes hands.
    void ask(quint64 client, const QString &name);
    /// True when that client held it.
    bool release(quint64 client);
    /// Whoever holds it: for stops.
    void revoke() { holder_.reset(); }
    /// Ends a lease that has run out; gives the name of who held it.
    std::optional<QString> expire(double now);

    /// Who holds it; 0: nobody.
    quint64 client() const { return holder_ ? holder_->client : 0; }
    bool isHeldBy(quint64 client) const { return holder_ && holder_->client == client; }
    LeaseState state(double now) const;

private:
    struct Holder {
        quint64 client;
        QString name;
        double timeout_s;
        double until;
        std::optional<QString> wanted;
    };

    Error heldByAnother() const;

    std::optional<Holder> holder_;
};

} // namespace hermes::motorcontrol
