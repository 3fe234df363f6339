#pragma once

#include <QObject>

namespace hermes {

/// Brings SIGINT, SIGTERM and SIGHUP into the event loop. One at a time.
class SignalWatcher : public QObject {
    Q_OBJECT
public:
    explicit SignalWatcher(QObject *parent);
    ~SignalWatcher() override;

Q_SIGNALS:
    /// name: "SIGTERM", "SIGINT" or "SIGHUP".
    void received(const QString &name);
};

} // namespace hermes
