#pragma once

#include "common/interface/InterfaceUrl.h"
#include "common/interface/Listener.h"

#include <QSet>
#include <QSslConfiguration>
#include <QTcpServer>
#include <QTimer>
#include <list>

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
    ~TlsServerInterface() override;

    /// Error also when the keys are not as they must be (KeyFolder).
    Result<void> listen() override;
    void close() override;
    QString address() const override;

private:
    class Server;

    void takePeers();
    void begin(QSslSocket *socket);
    void finish(QSslSocket *socket);
    void refuse(QSslSocket *socket, const QString &why);
    void lookAtRevoked();

    const InterfaceUrl url_;
    const QString folder_;
    std::unique_ptr<Server> server_;
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
