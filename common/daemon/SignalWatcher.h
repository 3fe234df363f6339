#pragma once

#include <QObject>

namespace hermes {

/// Brings SIGINT, SIGTERM and SIGHUP into the event loop. One at a time. On Windows Ctrl-C and Ctrl-Break are
/// "SIGINT" and the end of the console is "SIGHUP"; no other program can ask for an end so.
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
