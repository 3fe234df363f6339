#pragma once

#include "common/interface/Interface.h"
#include "common/interface/InterfaceUrl.h"

#include <QElapsedTimer>
#include <QHostAddress>
#include <QUdpSocket>

namespace hermes {

/// Whole datagrams over UDP. The URL names the local address to bind (`udp://0.0.0.0:2368`; port 0: any free
/// one); `peer=HOST:PORT` is where write() sends, without it the sender of the last datagram;
/// `receive_buffer=BYTES` asks the system for that much room. `from=ADDRESS` or `from=ADDRESS:PORT`: only
/// this sender is read; `from=first`: the first, until it is silent for 3 s.
class UdpInterface : public Interface {
    Q_OBJECT
public:
    UdpInterface(const InterfaceUrl &address, QObject *parent);

    QString name() const override;
    bool isDatagram() const override { return true; }
    qint64 bytesToWrite() const override { return 0; }
    /// "datagrams" that came while the room for them was full.
    QMap<QString, quint64> systemErrors() const override;
    Strangers strangers() const override { return strangers_; }
    /// The port bound, while open.
    quint16 localPort() const;

protected:
    void doOpen() override;
    void doClose() override;
    bool doWrite(const QByteArray &bytes) override;

private:
    void readAll();
    bool isRead(const QHostAddress &address, quint16 port);

    InterfaceUrl url_;
    QUdpSocket socket_;
    QHostAddress peer_;
    quint16 peerPort_ = 0;
    bool peerFixed_ = false;
    bool keepsToFirst_ = false;
    QHostAddress from_;          ///< who is read; null: all, or the next
    quint16 fromPort_ = 0;       ///< 0: any of it
    QVector<quint16> leftPorts_; ///< of its, from which it sent before; the last ones
    int returns_ = 0;            ///< of such ports, without a new one between
    QElapsedTimer sinceFrom_;
    Strangers strangers_;
};

} // namespace hermes
