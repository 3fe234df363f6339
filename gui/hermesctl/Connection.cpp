#include "gui/hermesctl/Connection.h"

#include "common/Project.h"

#include <QEventLoop>
#include <QTimer>

namespace hermes {

Result<QString> resolveDaemon(const QString &word, const QString &host) {
    if (word.contains(QLatin1Char(':')))
        return word;
    const quint16 port = defaultPort(word);
    if (port == 0) {
        return Error(ErrorCode::InvalidParams,
                     QStringLiteral("unknown daemon \"%1\", expected one of %2, or HOST:PORT, or a URL")
                         .arg(word, daemonNames().join(QStringLiteral(", "))));
    }
    const QString bracketed = host.contains(QLatin1Char(':')) ? QStringLiteral("[%1]").arg(host) : host;
    return QStringLiteral("%1:%2").arg(bracketed).arg(port);
}

Result<void> connectOnce(Client &client, const QString &address, std::chrono::milliseconds timeout) {
    QEventLoop loop;
    QTimer limit;
    QObject::connect(&client, &Client::connected, &loop, &QEventLoop::quit);
    QObject::connect(&client, &Client::disconnected, &loop, &QEventLoop::quit);
    QObject::connect(&limit, &QTimer::timeout, &loop, &QEventLoop::quit);
    const auto begun = client.connectTo(address);
    if (!begun)
        return begun;
    limit.start(timeout);
    if (!client.isConnected() && client.lastError().isEmpty())
        loop.exec();
    if (client.isConnected())
        return {};
    const QString reason = client.lastError();
    return Error(ErrorCode::Disconnected,
                 reason.isEmpty() ? QStringLiteral("%1: no answer").arg(client.address()) : reason);
}

} // namespace hermes
