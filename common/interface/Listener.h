#pragma once

#include "common/Result.h"
#include "common/interface/Interface.h"

#include <QObject>
#include <QPointer>

namespace hermes {

/// Where peers arrive: yields one open Interface a peer.
class Listener : public QObject {
    Q_OBJECT
public:
    /// Error names the address and the reason (a port in use, no such device).
    virtual Result<void> listen() = 0;
    virtual void close() = 0;
    /// Where it listens, with the port the system gave if 0 was asked for.
    virtual QString address() const = 0;

Q_SIGNALS:
    /// A peer has come; the receiver owns it.
    void accepted(hermes::Interface *peer);

protected:
    explicit Listener(QObject *parent)
        : QObject(parent) {}
    /// Whether so few descriptors are left that files and devices need them; said in the log. With none left
    /// accept() fails, and the event loop spins.
    static bool isScarce(qintptr descriptor);
};

/// A listener for carriers that have no connections (UDP, a serial line): the carrier itself is the one peer.
class SinglePeerListener : public Listener {
    Q_OBJECT
public:
    SinglePeerListener(Interface *carrier, QObject *parent);

    Result<void> listen() override;
    void close() override;
    QString address() const override;

private:
    QPointer<Interface> carrier_; // ends with the client it was given to
    QString lastAddress_;
};

} // namespace hermes
