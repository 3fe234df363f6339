#include "common/network/Publisher.h"

#include "common/Log.h"
#include "common/network/Avahi.h"

#include <QDBusMetaType>
#include <QDBusPendingCallWatcher>
#include <QSysInfo>
#include <QTimer>

namespace hermes {
namespace {

constexpr std::chrono::seconds retry{5}; // until there is a bus
constexpr int maxRenamed = 100;
const QString busName = QStringLiteral("hermes-announcement");
const QString networkSource = QStringLiteral("network");

} // namespace

Publisher::Publisher(const QString &daemon, const std::vector<AnnouncedPort> &ports)
    : daemon_(daemon)
    , ports_(ports)
    , bus_(busName) {
    qDBusRegisterMetaType<QList<QByteArray>>();
}

Publisher::~Publisher() {
    QDBusConnection::disconnectFromBus(busName); // Avahi withdraws what the connection announced
}

void Publisher::begin() {
    bus_ = QDBusConnection::connectToBus(QDBusConnection::SystemBus, busName);
    if (!bus_.isConnected()) {
        QDBusConnection::disconnectFromBus(busName);
        tellOnce("not announced: there is no system bus");
        QTimer::singleShot(retry, this, &Publisher::begin);
        return;
    }
    bus_.connect(QString(), "/org/freedesktop/DBus/Local", "org.freedesktop.DBus.Local", "Disconnected", this,
                 SLOT(onBusLost()));
    watcher_ = std::make_unique<QDBusServiceWatcher>(avahi::service, bus_);
    connect(watcher_.get(), &QDBusServiceWatcher::serviceRegistered, this, &Publisher::publish);
    connect(watcher_.get(), &QDBusServiceWatcher::serviceUnregistered, this, [this] { group_.clear(); });
    bus_.connect(avahi::service, "/", avahi::serverInterface, avahi::stateChanged, this,
                 SLOT(onServerState(int, QString)));
    publish();
}

void Publisher::call(const QString &path, const QString &interface, const QString &method,
                     const QVariantList &arguments, const Next &next) {
    auto *pending =
        new QDBusPendingCallWatcher(bus_.asyncCall(avahi::message(path, interface, method, arguments)), this);
    connect(pending, &QDBusPendingCallWatcher::finished, this, [this, next, pending, attempt = attempt_] {
        pending->deleteLater();
        if (attempt != attempt_)
            return; // begun anew meanwhile
        if (pending->isError())
            failed(pending->error().message());
        else
            next(pending->reply());
    });
}

void Publisher::publish() {
    withdraw();
    ++attempt_;
    call("/", avahi::serverInterface, "EntryGroupNew", {}, [this](const QDBusMessage &reply) {
        group_ = reply.arguments().value(0).value<QDBusObjectPath>().path();
        bus_.connect(avahi::service, group_, avahi::groupInterface, avahi::stateChanged, this,
                     SLOT(onGroupState(int, QString)));
        addPorts(group_);
    });
}

void Publisher::addPorts(const QString &group) {
    for (const AnnouncedPort &port : ports_)
        call(group, avahi::groupInterface, "AddService",
             {avahi::anyInterface, avahi::anyProtocol, avahi::noFlags, instanceName(port), avahi::serviceType,
              QString(), QString(), QVariant::fromValue(port.port), QVariant::fromValue(port.texts)},
             [](const QDBusMessage &) {});
    call(group, avahi::groupInterface, "Commit", {},
         [this](const QDBusMessage &) { tellOnce(QString("announced as %1").arg(avahi::serviceType)); });
}

void Publisher::withdraw() {
    if (!group_.isEmpty())
        bus_.send(avahi::message(group_, avahi::groupInterface, "Free", {}));
    group_.clear();
}

QString Publisher::instanceName(const AnnouncedPort &port) const {
    const QString name = QString("%1 on %2").arg(daemon_, QSysInfo::machineHostName());
    const int number = int(&port - ports_.data()) + renamed_ * int(ports_.size()) + 1;
    return number == 1 ? name : QString("%1 (%2)").arg(name).arg(number);
}

void Publisher::failed(const QString &reason) {
    ++attempt_; // what else was asked for in this one fails for the same reason
    if (reason.contains("collision", Qt::CaseInsensitive) && renamed_ < maxRenamed) {
        ++renamed_;
        return publish();
    }
    tellOnce(QString("not announced, but as soon as Avahi can: %1").arg(reason));
}

void Publisher::onServerState(int state, const QString &) {
    if (state == avahi::serverRunning) // it has a name of the host now, or another one
        publish();
}

void Publisher::onGroupState(int state, const QString &) {
    if (state == avahi::groupCollision)
        failed("name collision");
}

void Publisher::onBusLost() {
    ++attempt_;
    group_.clear();
    QDBusConnection::disconnectFromBus(busName);
    QTimer::singleShot(retry, this, &Publisher::begin);
}

void Publisher::tellOnce(const QString &text) {
    if (!std::exchange(isTold_, true))
        logInfo(networkSource, text);
}

} // namespace hermes
