#pragma once

#include "common/interface/Interface.h"
#include "common/interface/InterfaceUrl.h"

#include <QHostAddress>
#include <QUdpSocket>

namespace hermes {

/// Whole datagrams over UDP. The URL names the local address to bind (`udp://0.0.0.0:2368`; port 0: any free
/// one); `peer=HOST:PORT` is where write() sends, without it the sender of the last datagram;
/// `receive_buffer=BYTES` asks the system for that much room.
class UdpInterface : public Interface {
    Q_OBJECT
public:
    UdpInterface(const InterfaceUrl &address, QObject *parent);

    QString name() const override;
    bool isDatagram() const override { return true; }
    qint64 bytesToWrite() const override { return 0; }
    /// "datagrams" that came while the room for them was full.
    QMap<QString, quint64> systemErrors() const override;
    /// The port bound, while open.
    quint16 localPort() const;

protected:
    void doOpen() override;
    void doClose() override;
    bool doWrite(const QByteArray &bytes) override;

private:
    void readAll();

    InterfaceUrl url_;
    QUdpSocket socket_;
    QHostAddress peer_;
    quint16 peerPort_ = 0;
    bool peerFixed_ = false;
};

} // namespace hermes
