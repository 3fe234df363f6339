#pragma once

#include "common/interface/Interface.h"
#include "common/interface/InterfaceUrl.h"

#include <QBasicTimer>
#include <QHostAddress>
#include <QPointer>
#include <QTcpSocket>
#include <deque>

namespace hermes {

/// A byte stream over TCP: a client that connects to an address, or the server's side of one connection. A
/// peer that vanished without a word is found within 5 s. With the option `own=1` a client tries the daemon's
/// Unix socket first (OwnSocket.h).
class TcpInterface : public Interface {
    Q_OBJECT
public:
    TcpInterface(const InterfaceUrl &address, QObject *parent);
    /// Takes over a connected socket. host outlives it, and its farewell.
    TcpInterface(QTcpSocket *connected, QObject *host);

    QString name() const override;
    bool isConnection() const override { return true; }
    Peer peer() const override;
    void flush() override;
    qint64 bytesToWrite() const override { return waitingBytes_ + bytesInSocket(); }
    bool setReceiving(bool on) override;
    bool hasUnread() const override;
    double unreadSince() const override { return unreadSince_; }

protected:
    /// A client over a socket of another kind, which begins when that says so.
    TcpInterface(const InterfaceUrl &address, QTcpSocket *socket, QObject *parent);
    void doOpen() override;
    void doClose() override;
    bool doWrite(const QByteArray &bytes) override;
    bool isConnected() const { return socket_->state() == QAbstractSocket::ConnectedState; }
    /// Goes on with a socket that somebody else has connected.
    void takeConnected(qintptr descriptor);

    /// The socket is connected, and may carry messages.
    void begin();
    /// Why the socket has failed.
    virtual QString failure() const { return socket_->errorString(); }
    /// After a read: whether something is left.
    virtual void noteRead();
    /// Given to the socket, and not yet to the system.
    virtual qint64 bytesInSocket() const { return socket_->bytesToWrite(); }
    void noteWritten();

private:
    void prepare();
    void watchPeer();
    void timerEvent(QTimerEvent *event) override;
    int connectToOwn() const;
    void readSome();
    void noteUnread();
    void readLater();
    void handOver();
    void forgetWaiting();

    InterfaceUrl url_;
    QTcpSocket *const socket_;
    QPointer<QObject> host_; // of a peer of a server
    QBasicTimer watch_;
    // Not yet given to the socket: that copies, or encrypts, all that it is given at once.
    std::deque<QByteArray> waiting_;
    int begunBytes_ = 0; // of the first of them, which have been given
    qint64 waitingBytes_ = 0;
    bool readsOn_ = false; // the rest is read when others have had their turn
    bool receiving_ = true;
    bool hasLeft_ = false; // something was unread at the last look
    double unreadSince_ = 0;
};

} // namespace hermes
