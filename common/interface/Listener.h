#pragma once

#include "common/Result.h"
#include "common/interface/Interface.h"

#include <QObject>
#include <QPointer>
#include <QTimer>
#include <functional>

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
    /// Why nobody can come now; empty: somebody can.
    virtual QString failure() const { return {}; }

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
/// One that fails, an adapter that was unplugged, is opened again as soon as it can be, as another peer.
class SinglePeerListener : public Listener {
    Q_OBJECT
public:
    using Make = std::function<Interface *()>;

    SinglePeerListener(Make make, QObject *parent);

    Result<void> listen() override;
    void close() override;
    QString address() const override { return address_; }
    QString failure() const override { return failure_; }

private:
    bool open();
    void lose(const QString &reason);

    const Make make_;
    QPointer<Interface> carrier_; // ends with the client it was given to
    QString address_;
    QString failure_;
    QString told_; // in the log
    double toldAt_ = 0;
    QTimer retry_;
};

} // namespace hermes
