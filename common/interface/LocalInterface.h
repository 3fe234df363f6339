#pragma once

#include "common/interface/TcpInterface.h"

namespace hermes {

/// A byte stream over a Unix socket, between programs of one computer: local:///run/hermes/motorcontrol.sock.
/// A socket of TCP in all but how it is connected.
class LocalInterface : public TcpInterface {
    Q_OBJECT
public:
    LocalInterface(const InterfaceUrl &address, QObject *parent);
    /// Takes over the socket of a peer of a server; name and user say who that is.
    LocalInterface(QTcpSocket *connected, const QString &name, uint user, QObject *host);

    QString name() const override { return name_; }
    Peer peer() const override { return {Peer::Place::UnixSocket, user_}; }

protected:
    void doOpen() override;

private:
    const QString path_;
    const QString name_;
    const std::optional<uint> user_; // of a peer of a server
};

} // namespace hermes
