#pragma once

#include "common/interface/TcpListener.h"

namespace hermes {

/// Listens on a TCP address and yields one TcpInterface a peer.
class TcpServerInterface : public TcpListener {
    Q_OBJECT
public:
    TcpServerInterface(const InterfaceUrl &address, QObject *parent);

protected:
    void take(qintptr descriptor) override;
    bool isHeard(qintptr descriptor) const override;
};

} // namespace hermes
