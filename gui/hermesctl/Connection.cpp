#include "gui/hermesctl/Connection.h"

#include <QEventLoop>
#include <QTimer>

namespace hermes {

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
