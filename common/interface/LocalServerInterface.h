#pragma once

#include "common/interface/InterfaceUrl.h"
#include "common/interface/Listener.h"

#include <QSocketNotifier>
#include <memory>

namespace hermes {

class LocalAddress;

/// Listens on a Unix socket and yields one LocalInterface a peer; each is named after the process and the
/// user that the system says it is. The socket is a file that only its owner may open, unless the option
/// `mode` says otherwise: local:///run/hermes/motorcontrol.sock?mode=0660. One that a program left behind is
/// replaced. A path that begins with @ is an abstract name, which no file has and anyone may open.
class LocalServerInterface : public Listener {
    Q_OBJECT
public:
    LocalServerInterface(const InterfaceUrl &address, QObject *parent);
    ~LocalServerInterface() override;

    Result<void> listen() override;
    void close() override;
    QString address() const override { return url_.toString(); }

private:
    Error refuse(const QString &why) const;
    Result<void> makeFree(const LocalAddress &address) const;
    void takePeers();
    void take(int descriptor);

    const InterfaceUrl url_;
    int descriptor_ = -1;
    quint64 file_ = 0; // its inode, 0: it is none
    std::unique_ptr<QSocketNotifier> arrivals_;
};

} // namespace hermes
