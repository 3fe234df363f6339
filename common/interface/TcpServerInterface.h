#pragma once

#include "common/interface/InterfaceUrl.h"
#include "common/interface/Listener.h"

#include <QTcpServer>

namespace hermes {

/// Listens on a TCP address and yields one TcpInterface a peer.
class TcpServerInterface : public Listener {
    Q_OBJECT
public:
    TcpServerInterface(const InterfaceUrl &address, QObject *parent);

    Result<void> listen() override;
    void close() override;
    QString address() const override;

private:
    void takePeers();
    void take(QTcpSocket *socket);

    InterfaceUrl url_;
    QTcpServer server_;
};

} // namespace hermes
