#pragma once

#include <QDBusMessage>
#include <QString>
#include <QVariantList>

namespace hermes::avahi {

// Names and numbers of Avahi's interface on the system bus, as its files org.freedesktop.Avahi.*.xml and
// defs.h tell.
const QString service = QStringLiteral("org.freedesktop.Avahi");
const QString serverInterface = service + QStringLiteral(".Server");
const QString groupInterface = service + QStringLiteral(".EntryGroup");
const QString browserInterface = service + QStringLiteral(".ServiceBrowser");
const QString stateChanged = QStringLiteral("StateChanged");

constexpr int anyInterface = -1;
constexpr int anyProtocol = -1;
constexpr int serverRunning = 2;
constexpr int groupCollision = 3;
constexpr uint noFlags = 0;

/// What daemons of Hermes announce.
const QString serviceType = QStringLiteral("_hermes._tcp");

/// A call that does not start Avahi where it does not run.
inline QDBusMessage message(const QString &path, const QString &interface, const QString &method,
                            const QVariantList &arguments) {
    QDBusMessage call = QDBusMessage::createMethodCall(service, path, interface, method);
    call.setAutoStartService(false);
    call.setArguments(arguments);
    return call;
}

} // namespace hermes::avahi
