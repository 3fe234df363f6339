#pragma once

#include <QObject>
#include <QProcess>
#include <QStringList>
#include <QTimer>

namespace hermes::desktop {

/// Looks for daemons on the network, by hermesctl as a process of its own: a bus that does not answer holds
/// up nobody.
class NetworkSearch : public QObject {
    Q_OBJECT
public:
    explicit NetworkSearch(QObject *parent);
    ~NetworkSearch() override;

    /// Takes some seconds; nothing more while one is under way.
    void start();
    bool isRunning() const { return process_.state() != QProcess::NotRunning; }

Q_SIGNALS:
    void found(const QStringList &urls);
    void failed(const QString &why);

private:
    void finish(int status);

    QProcess process_;
    QTimer limit_;
};

} // namespace hermes::desktop
