#pragma once

#include "common/network/Announcement.h"

#include <QDBusConnection>
#include <QDBusMessage>
#include <QDBusObjectPath>
#include <QDBusServiceWatcher>
#include <QObject>
#include <functional>
#include <memory>

namespace hermes {

/// What an Announcement does in its thread: a connection to the system bus, and there a group of entries of
/// Avahi.
class Publisher : public QObject {
    Q_OBJECT
public:
    Publisher(const QString &daemon, const std::vector<AnnouncedPort> &ports);
    ~Publisher() override;

    void begin();

private Q_SLOTS:
    void onServerState(int state, const QString &error);
    void onGroupState(int state, const QString &error);
    void onBusLost();

private:
    using Next = std::function<void(const QDBusMessage &reply)>;

    void publish();
    void addPorts(const QString &group);
    void withdraw();
    void call(const QString &path, const QString &interface, const QString &method,
              const QVariantList &arguments, const Next &next);
    void failed(const QString &reason);
    void tellOnce(const QString &text);
    QString instanceName(const AnnouncedPort &port) const;

    const QString daemon_;
    const std::vector<AnnouncedPort> ports_;
    QDBusConnection bus_;
    std::unique_ptr<QDBusServiceWatcher> watcher_; ///< of Avahi on that bus
    QString group_;                                ///< path of the entries; "": none
    quint64 attempt_ = 0;
    int renamed_ = 0; ///< how often another one had the name
    bool isTold_ = false;
};

} // namespace hermes
