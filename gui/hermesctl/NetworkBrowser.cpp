#include "gui/hermesctl/NetworkBrowser.h"

#include "common/network/Avahi.h"

#include <QDBusArgument>
#include <QDBusMetaType>
#include <QDBusPendingCallWatcher>
#include <QEventLoop>
#include <QHostAddress>
#include <QTimer>

namespace hermes::ctl {
namespace {

/// Which of two addresses of a daemon to tell: one by which most can reach it.
int worth(const QString &text) {
    const QHostAddress address(text);
    if (address.isLoopback())
        return 0;
    if (address.isLinkLocal())
        return 1;
    return address.protocol() == QAbstractSocket::IPv4Protocol ? 3 : 2;
}

QJsonObject textsOf(const QVariant &records) {
    QJsonObject texts;
    for (const QByteArray &record : qdbus_cast<QList<QByteArray>>(records)) {
        const int equals = record.indexOf('=');
        if (equals > 0)
            texts.insert(QString::fromUtf8(record.left(equals)), QString::fromUtf8(record.mid(equals + 1)));
    }
    return texts;
}

Error absent(const QString &what) {
    return {ErrorCode::Disconnected, QString("the network cannot be asked: %1; start avahi-daemon here, or "
                                             "ask one computer: hermesctl list --host HOST")
                                         .arg(what)};
}

} // namespace

NetworkBrowser::NetworkBrowser()
    : bus_(QDBusConnection::systemBus()) {
    qDBusRegisterMetaType<QList<QByteArray>>();
}

Result<QList<QJsonObject>> NetworkBrowser::look(std::chrono::milliseconds howLong) {
    if (!bus_.isConnected())
        return absent("there is no system bus (D-Bus)");
    // Before the browser is made, whose path is not known: the first items come at once.
    bus_.connect(avahi::service, QString(), avahi::browserInterface, "ItemNew", this,
                 SLOT(onItem(int, int, QString, QString, QString, uint)));
    const QDBusMessage begun = bus_.call(avahi::message("/", avahi::serverInterface, "ServiceBrowserNew",
                                                        {avahi::anyInterface, avahi::anyProtocol,
                                                         avahi::serviceType, QString(), avahi::noFlags}),
                                         QDBus::Block, int(howLong.count()) + 1000);
    if (begun.type() == QDBusMessage::ErrorMessage)
        return absent(begun.errorMessage());
    QEventLoop loop;
    QTimer::singleShot(howLong, &loop, &QEventLoop::quit);
    loop.exec();
    return found_.values();
}

void NetworkBrowser::onItem(int interface, int protocol, const QString &name, const QString &type,
                            const QString &domain, uint) {
    auto *pending = new QDBusPendingCallWatcher(
        bus_.asyncCall(avahi::message("/", avahi::serverInterface, "ResolveService",
                                      {interface, protocol, name, type, domain, protocol, avahi::noFlags})),
        this);
    connect(pending, &QDBusPendingCallWatcher::finished, this, [this, pending] {
        pending->deleteLater();
        if (!pending->isError())
            onResolved(pending->reply());
    });
}

void NetworkBrowser::onResolved(const QDBusMessage &reply) {
    // interface, protocol, name, type, domain, host, protocol of the address, address, port, texts, flags
    const QVariantList values = reply.arguments();
    if (values.size() < 11)
        return;
    QJsonObject daemon = textsOf(values[9]);
    daemon.insert("host", values[5].toString());
    daemon.insert("address", values[7].toString());
    daemon.insert("port", values[8].toInt());
    QJsonObject &known = found_[values[2].toString()];
    if (known.isEmpty() || worth(values[7].toString()) > worth(known["address"].toString()))
        known = daemon;
}

} // namespace hermes::ctl
