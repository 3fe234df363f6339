#pragma once

#include "common/interface/TcpInterface.h"

namespace hermes {

/// A byte stream over a Unix socket, between programs of one computer: local:///run/hermes/motorcontrol.sock.
/// A socket of TCP in all but how it is connected.
class LocalInterface : public TcpInterface {
    Q_OBJECT
public:
    LocalInterface(const InterfaceUrl &address, QObject *parent);
    /// Takes over the socket of a peer of a server; name says who that is.
    LocalInterface(QTcpSocket *connected, const QString &name, QObject *host);

    QString name() const override { return name_; }

protected:
    void doOpen() override;

private:
    const QString path_;
    const QString name_;
};

} // namespace hermes
