#pragma once

#include "common/interface/InterfaceUrl.h"
#include "common/interface/Listener.h"

#include <QHostAddress>
#include <QSocketNotifier>
#include <QTcpServer>
#include <memory>

namespace hermes {

/// What listeners on a TCP address share: it takes a few peers at a time, and those who have gone cost hardly
/// anything, so that nobody waits long behind a storm of strangers.
class TcpListener : public Listener {
    Q_OBJECT
public:
    Result<void> listen() override;
    void close() override;
    QString address() const override;

protected:
    /// atOnce: peers that are taken before the event loop goes on. silent_s: for so long one that says
    /// nothing is not seen; 0: each is seen at once.
    TcpListener(const InterfaceUrl &address, int atOnce, int silent_s, QObject *parent);

    virtual void take(qintptr descriptor) = 0;
    /// Whether one that has closed its end may still want something.
    virtual bool isHeard(qintptr descriptor) const = 0;
    virtual void noteGone(const QHostAddress &) {}

    const InterfaceUrl url_;

private:
    void takePeers();

    const int atOnce_, silent_s_;
    QTcpServer server_; // its peers are taken here
    std::unique_ptr<QSocketNotifier> arrivals_;
};

} // namespace hermes
