#pragma once

#include "common/Result.h"
#include "common/daemon/Session.h"
#include "common/daemon/TopicHub.h"
#include "common/interface/InterfaceUrl.h"
#include "common/interface/Listener.h"

#include <QMap>
#include <QObject>
#include <QTimer>

namespace hermes {

/// The command channels of a daemon: its listeners and the clients that came through them.
class Server : public QObject {
    Q_OBJECT
public:
    /// Beyond limits.clients, for clients that call urgent commands.
    static constexpr int keptPlaces = 16;

    Server(const CommandRegistry &commands, TopicHub &topics, QObject *parent);

    /// For clients that come from now on.
    void setLimits(const SessionLimits &session, int clients);
    /// For all clients, at once.
    void setAccess(const Access &access);
    /// Adds a listener; beside one at a TCP address on loopback, one for programs of the daemon's own user
    /// (OwnSocket.h). Error: an unknown scheme or protocol, a port in use, an address that is open to the
    /// network although insecure is false.
    Result<void> listen(const QString &url, bool insecure);
    void close();

    /// Where it listens, with actual ports.
    QStringList addresses() const;
    /// What is wrong with listeners: a device that is gone.
    QStringList failures() const;
    Session *session(quint64 id) const { return sessions_.value(id); }
    GapWatch &gaps() { return gapWatch_; }
    Audit &audit() { return audit_; }
    /// Clients now and in all, requests, errors, damaged and oversized frames, dropped topic messages,
    /// clients closed at a limit or turned away, and how good lines are that have the framing `serial`.
    QJsonObject counters() const;

Q_SIGNALS:
    /// A client has gone: what it held (a lease, a job) ends with it.
    void clientGone(quint64 client);

private:
    Result<Listener *> begin(const InterfaceUrl &url);
    Result<Listener *> listenForOwn(const InterfaceUrl &tcp);
    void accept(Interface *peer, const QString &protocol);
    void giveRole(Session *session) const;
    bool mayStay(Session *session);
    int maxPlaces() const;
    void saveMemory();
    bool makeKeptPlace();
    void turnAway(Session *session, const RpcError &reason);
    QVector<Session *> restricted() const;
    int places() const { return sessions_.size() - restricted().size(); }
    void givePlaces();
    void remove(Session *session, const QString &reason);
    void giveMemoryBack();

    const CommandRegistry &commands_;
    TopicHub &topics_;
    GapWatch gapWatch_;
    Audit audit_;
    SessionLimits limits_;
    int clientLimit_ = 16;
    Access access_;
    QVector<Listener *> listeners_;
    QVector<Listener *> ownListeners_; // beside those
    QMap<quint64, Session *> sessions_;
    quint64 lastId_ = 0;
    quint64 turnedAway_ = 0;
    double turnAwayTold_ = 0; // monotonic
    QJsonObject past_;        // the sums of clients that have gone
    double giveBackFrom_ = 0; // monotonic: when memory is given back; 0: when another client has gone
    QTimer idleTimer_;
};

} // namespace hermes
