#include "gui/hermesctl/Loggers.h"

#include "common/Project.h"
#include "common/client/DaemonAddress.h"

#include <QJsonArray>
#include <algorithm>
#include <numeric>

namespace hermes {
namespace {

Result<QStringList> addressesOf(const Arguments &arguments) {
    QStringList addresses;
    for (const QString &word : arguments.daemons.isEmpty() ? daemonNames() : arguments.daemons) {
        const Result<QString> address = daemonAddress(word, arguments.host);
        if (!address)
            return address.error();
        if (!addresses.contains(*address))
            addresses.append(*address);
    }
    return addresses;
}

bool records(const QJsonValue &description) {
    const QJsonArray methods = description[QStringLiteral("methods")].toArray();
    return std::any_of(methods.begin(), methods.end(), [](const QJsonValue &method) {
        return method[QStringLiteral("name")].toString() == QStringLiteral("record.start");
    });
}

QString complaint(const QString &address, const QString &why) {
    return QStringLiteral("%1: %2").arg(address, why.isEmpty() ? QStringLiteral("no answer") : why);
}

} // namespace

Result<Loggers> Loggers::find(const Arguments &arguments) {
    const Result<QStringList> addresses = addressesOf(arguments);
    if (!addresses)
        return addresses.error();
    Loggers loggers;
    loggers.timeout_ = arguments.timeout;
    QStringList absent, others;
    auto clients = connectAll(*addresses, arguments.timeout);
    for (std::size_t i = 0; i < clients.size(); ++i) {
        if (clients[i]->isConnected())
            loggers.members_.push_back({addresses->at(int(i)), std::move(clients[i])});
        else
            absent.append(complaint(addresses->at(int(i)), clients[i]->lastError()));
    }
    loggers.keepThoseThatRecord(others);
    if (!arguments.daemons.isEmpty() && !(absent + loggers.silent_ + others).isEmpty())
        return Error(ErrorCode::Disconnected, (absent + loggers.silent_ + others).join(QStringLiteral("; ")));
    if (loggers.members_.empty())
        return Error(ErrorCode::Disconnected,
                     (QStringList(QStringLiteral("no logger answers at its default port on %1; --daemons "
                                                 "names others")
                                      .arg(arguments.host)) +
                      loggers.silent_)
                         .join(QStringLiteral("; ")));
    return loggers;
}

void Loggers::keepThoseThatRecord(QStringList &others) {
    const Replies infos = call(QStringLiteral("daemon.info"));
    const Replies descriptions = call(QStringLiteral("rpc.discover"));
    std::vector<Member> all;
    all.swap(members_);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Result<QJsonValue> &reply = infos[i] ? descriptions[i] : infos[i];
        if (!reply) {
            silent_.append(complaint(all[i].name, reply.error().message));
        } else if (!records(*reply)) {
            others.append(complaint(all[i].name, QStringLiteral("no logger, record.start is missing")));
        } else {
            const QString name = (*infos[i])[QStringLiteral("name")].toString();
            const bool known = std::any_of(members_.begin(), members_.end(),
                                           [&](const Member &member) { return member.name == name; });
            members_.push_back(
                {known ? name + QLatin1Char('@') + all[i].name : name, std::move(all[i].client)});
        }
    }
}

Loggers::Numbers Loggers::everyone() const {
    Numbers numbers(members_.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

Loggers::Replies Loggers::call(const Numbers &numbers, const QString &method, const QJsonObject &params,
                               std::chrono::milliseconds atLeast) const {
    return callEach(numbers, method, std::vector<QJsonObject>(numbers.size(), params), atLeast);
}

Loggers::Replies Loggers::callEach(const Numbers &numbers, const QString &method,
                                   const std::vector<QJsonObject> &params,
                                   std::chrono::milliseconds atLeast) const {
    std::vector<ClientCall> calls;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        calls.push_back({members_[numbers[i]].client.get(), params[i]});
    return callAll(calls, method, std::max(timeout_, atLeast));
}

} // namespace hermes
