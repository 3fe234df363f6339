#pragma once

#include "common/interface/InterfaceUrl.h"
#include "common/interface/Listener.h"

#include <QHostAddress>
#include <QSet>
#include <QSocketNotifier>
#include <QSslConfiguration>
#include <QTcpServer>
#include <QTimer>
#include <list>
#include <memory>

class QSslSocket;

namespace hermes {

class TlsInterface;

/// Listens for TLS on a TCP address and yields one TlsInterface a peer whose certificate is of the same
/// authority, valid and not revoked: tls://0.0.0.0:7411?keys=FOLDER. Others are closed, with the reason in
/// the log; who is revoked later is closed within a second.
class TlsServerInterface : public Listener {
    Q_OBJECT
public:
    TlsServerInterface(const InterfaceUrl &address, QObject *parent);

    /// Error also when the keys are not as they must be (KeyFolder).
    Result<void> listen() override;
    void close() override;
    QString address() const override;

private:
    void takePeers();
    void begin(qintptr descriptor);
    void finish(QSslSocket *socket);
    void refuse(QSslSocket *socket, const QString &why);
    void countRefused(const QHostAddress &from, const QString &why);
    void lookAtRevoked();
    void closeBad();

    const InterfaceUrl url_;
    const QString folder_;
    QTcpServer server_; // its peers are taken here
    std::unique_ptr<QSocketNotifier> arrivals_;
    QSslConfiguration keys_;
    QSet<QByteArray> revoked_;
    QString revokedState_; // of the file, as last read
    QString revokedProblem_;
    QTimer revokedTimer_;
    std::list<QSslSocket *> handshakes_; // under way, the oldest first
    std::list<TlsInterface *> peers_;
    quint64 refused_ = 0;
    double refusedTold_ = 0; // monotonic
};

} // namespace hermes
