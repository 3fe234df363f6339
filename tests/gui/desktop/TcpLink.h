#pragma once

namespace hermes {

/// A way to a daemon of this computer on which everything takes a while, and which can be cut: what is under
/// way then is lost.
class TcpLink {
public:
    explicit TcpLink(quint16 to, std::chrono::milliseconds delay = {})
        : delay_(delay) {
        if (!server_.listen(QHostAddress::LocalHost))
            qFatal("no port is free");
        port_ = server_.serverPort();
        QObject::connect(&server_, &QTcpServer::newConnection, &server_, [this, to] {
            QTcpSocket *const near = server_.nextPendingConnection();
            auto *const far = new QTcpSocket(near);
            far->connectToHost(QHostAddress::LocalHost, to);
            carry(near, far, true);
            carry(far, near, false);
            QObject::connect(near, &QTcpSocket::disconnected, near, &QObject::deleteLater);
        });
    }
    quint16 port() const { return port_; }
    /// Until mend().
    void cut() {
        server_.close();
        for (auto *const near : server_.findChildren<QTcpSocket *>(QString(), Qt::FindDirectChildrenOnly))
            near->abort();
    }
    bool mend() { return server_.listen(QHostAddress::LocalHost, port_); }
    /// Breaks the connection once, as soon as these bytes have gone to the daemon.
    void cutAfter(const QByteArray &bytes) { cutAfter_ = bytes; }
    bool wasCut() const { return wasCut_; }

private:
    void carry(QTcpSocket *from, QTcpSocket *to, bool isToDaemon) {
        QObject::connect(from, &QTcpSocket::readyRead, to, [this, from, to, isToDaemon] {
            QTimer::singleShot(delay_, to, [this, from, to, isToDaemon, bytes = from->readAll()] {
                to->write(bytes);
                if (isToDaemon && !cutAfter_.isEmpty() && bytes.contains(cutAfter_))
                    breakOff(*from, *to);
            });
        });
    }
    void breakOff(QTcpSocket &near, QTcpSocket &far) {
        cutAfter_.clear();
        while (far.bytesToWrite() > 0 && far.waitForBytesWritten(1000)) {
        }
        wasCut_ = true;
        near.abort(); // the answer finds nobody
    }

    const std::chrono::milliseconds delay_;
    QByteArray cutAfter_;
    bool wasCut_ = false;
    QTcpServer server_;
    quint16 port_ = 0;
};

} // namespace hermes
