#pragma once

#include "common/Result.h"

#include <QDBusConnection>
#include <QDBusMessage>
#include <QJsonObject>
#include <QMap>
#include <QObject>

namespace hermes::ctl {

/// Finds the daemons that announce themselves on the network, through Avahi.
class NetworkBrowser : public QObject {
    Q_OBJECT
public:
    NetworkBrowser();

    /// Looks for a while, in a nested event loop: {name, host, address, port, framing, protocol, tls}
    /// of each and {robot, robot_id} of those that know, by names. Error: Avahi or D-Bus does not run here.
    Result<QList<QJsonObject>> look(std::chrono::milliseconds howLong);

private Q_SLOTS:
    void onItem(int interface, int protocol, const QString &name, const QString &type, const QString &domain,
                uint flags);

private:
    void onResolved(const QDBusMessage &reply);

    QDBusConnection bus_;
    QMap<QString, QJsonObject> found_; ///< by names of instances: one of the addresses of each
};

} // namespace hermes::ctl
