#pragma once

#include "common/interface/TcpListener.h"

#include <QSet>
#include <QSslConfiguration>
#include <QTimer>
#include <list>

class QSslSocket;

namespace hermes {

class TlsInterface;

/// Listens for TLS on a TCP address and yields one TlsInterface a peer whose certificate is of the same
/// authority, valid and not revoked: tls://0.0.0.0:7411?keys=FOLDER. Others are closed, with the reason in
/// the log; who is revoked later is closed within a second.
class TlsServerInterface : public TcpListener {
    Q_OBJECT
public:
    TlsServerInterface(const InterfaceUrl &address, QObject *parent);

    /// Error also when the keys are not as they must be (KeyFolder).
    Result<void> listen() override;
    void close() override;

protected:
    void take(qintptr descriptor) override;
    bool isHeard(qintptr) const override { return false; }
    void noteGone(const QHostAddress &from) override;

private:
    void finish(QSslSocket *socket);
    void refuse(QSslSocket *socket, const QString &why);
    /// The oldest handshake of the address that has most of them.
    QSslSocket *oldestOfTheMost() const;
    void countRefused(const QHostAddress &from, const QString &why);
    void lookAtRevoked();
    void closeBad();

    const QString folder_;
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
