#include "gui/hermesctl/Connection.h"
#include "common/interface/InterfaceUrl.h"

#include "common/client/DaemonAddress.h"
#include "gui/hermesctl/Hosts.h"
#include "gui/hermesctl/Waiting.h"

#include <QTimer>
#include <algorithm>

namespace hermes::ctl {

Result<void> connectOnce(Client &client, const QString &address, std::chrono::milliseconds timeout) {
    if (const auto url = InterfaceUrl::parse(address); !url)
        return url.error();
    const Waiting waiting(timeout);
    QEventLoop loop;
    QTimer limit;
    QObject::connect(&client, &Client::connected, &loop, &QEventLoop::quit);
    QObject::connect(&client, &Client::disconnected, &loop, &QEventLoop::quit);
    QObject::connect(&limit, &QTimer::timeout, &loop, &QEventLoop::quit);
    const auto begun = client.connectTo(asOwner(address));
    if (!begun)
        return begun;
    limit.start(timeout);
    if (!client.isConnected() && client.lastError().isEmpty())
        loop.exec();
    if (client.isConnected()) {
        rememberHost(address);
        return {};
    }
    return Error(ErrorCode::Disconnected, client.problem());
}

std::vector<std::unique_ptr<Client>> connectAll(const QStringList &addresses,
                                                std::chrono::milliseconds timeout) {
    const Waiting waiting(timeout);
    QEventLoop loop;
    QTimer::singleShot(timeout, &loop, &QEventLoop::quit);
    std::vector<std::unique_ptr<Client>> clients;
    std::size_t open = std::size_t(addresses.size());
    for (const QString &address : addresses) {
        Client *const client = clients.emplace_back(std::make_unique<Client>()).get();
        const auto done = [&loop, &open, client] {
            QObject::disconnect(client, nullptr, &loop, nullptr);
            if (--open == 0)
                loop.quit();
        };
        QObject::connect(client, &Client::connected, &loop, done);
        QObject::connect(client, &Client::disconnected, &loop, done);
        if (!client->connectTo(asOwner(address)))
            done();
    }
    if (open > 0)
        loop.exec();
    for (std::size_t i = 0; i < clients.size(); ++i)
        clients[i]->isConnected() ? rememberHost(addresses[int(i)]) : clients[i]->close();
    return clients;
}

std::vector<Result<QJsonValue>> callAllAndWait(const std::vector<Client *> &clients, const QString &method,
                                               std::chrono::milliseconds timeout) {
    const Waiting waiting(timeout);
    QEventLoop loop;
    std::vector<Result<QJsonValue>> replies(clients.size(), Error(ErrorCode::Disconnected, method));
    auto open = clients.size() - std::size_t(std::count(clients.begin(), clients.end(), nullptr));
    for (std::size_t i = 0; i < clients.size(); ++i)
        if (clients[i])
            clients[i]->call(
                method, QJsonObject(),
                [&, i](const Result<QJsonValue> &result) {
                    replies[i] = result;
                    if (--open == 0)
                        loop.quit();
                },
                timeout);
    if (open > 0)
        loop.exec();
    return replies;
}

} // namespace hermes::ctl
