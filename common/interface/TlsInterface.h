#pragma once

#include "common/interface/TcpInterface.h"

#include <QSslSocket>

namespace hermes {

/// A byte stream over TLS with certificates on both sides: tls://robot:7411?keys=FOLDER; without keys the
/// user's (KeyFolder). A client speaks to whoever has a daemon's certificate of its own authority.
class TlsInterface : public TcpInterface {
    Q_OBJECT
public:
    TlsInterface(const InterfaceUrl &address, QObject *parent);
    /// Takes over the encrypted socket of a peer of a server, whose certificate is valid.
    TlsInterface(QSslSocket *encrypted, QObject *host);

    QString name() const override;
    Peer peer() const override;
    /// Also when it is not decrypted as yet.
    bool hasUnread() const override {
        return TcpInterface::hasUnread() || socket_->encryptedBytesAvailable() > 0;
    }

protected:
    void doOpen() override;
    /// OpenSSL may have more that nobody can ask it for: it is decrypted in the next turn of the event loop.
    void noteRead() override;
    /// With what waits encrypted.
    qint64 bytesInSocket() const override {
        return socket_->bytesToWrite() + socket_->encryptedBytesToWrite();
    }
    QString failure() const override { return refused_.isEmpty() ? TcpInterface::failure() : refused_; }

private:
    TlsInterface(const InterfaceUrl &address, QSslSocket *socket, QObject *parent);
    void onEncrypted();
    QString folder() const;

    const InterfaceUrl url_;
    QSslSocket *const socket_;
    quint64 reads_ = 0;
    QString refused_; ///< why, where this client does not accept the certificate there
};

} // namespace hermes
