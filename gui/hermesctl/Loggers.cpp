#include "gui/hermesctl/Loggers.h"

#include "common/Project.h"
#include "common/client/DaemonAddress.h"

#include <QJsonArray>
#include <algorithm>

namespace hermes::ctl {
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

/// The one of that name; undefined: there is none.
QJsonValue named(const QJsonValue &list, const QString &name) {
    for (const QJsonValue &one : list.toArray())
        if (one["name"].toString() == name)
            return one;
    return QJsonValue::Undefined;
}

/// Whether a description tells of a method, and, if a parameter is given, that it takes that.
bool has(const QJsonValue &description, const QString &method, const QString &param) {
    const QJsonValue found = named(description["methods"], method);
    return param.isEmpty() ? found.isObject() : named(found["params"], param).isObject();
}

/// Lines for those that are no loggers; those that do not say what they are go to the silent ones.
QStringList identify(SessionMembers &members, const std::vector<SessionMember> &daemons) {
    const auto infos = callAllAndWait(callsOf(daemons), "daemon.info", members.timeout);
    const auto descriptions = callAllAndWait(callsOf(daemons), "rpc.discover", members.timeout);
    QStringList others;
    for (std::size_t i = 0; i < daemons.size(); ++i) {
        const SessionReply &reply = infos[i].result ? descriptions[i] : infos[i];
        if (!reply.result)
            members.silent.append(reply.complaint() + " (is it a logger? --daemons names those that are)");
        else if (!members.add((*infos[i].result)["name"].toString(), *daemons[i].client,
                              [&](const QString &method, const QString &param) {
                                  return has(*reply.result, method, param);
                              }))
            others.append(daemons[i].name + ": no logger, record.start is missing");
    }
    return others;
}

} // namespace

Result<Loggers> Loggers::find(const Arguments &arguments) {
    const Result<QStringList> addresses = addressesOf(arguments);
    if (!addresses)
        return addresses.error();
    Loggers loggers;
    loggers.clients = connectAll(*addresses, arguments.timeout);
    loggers.members.timeout = arguments.timeout;
    QStringList faults;
    std::vector<SessionMember> daemons;
    for (int i = 0; i < addresses->size(); ++i) {
        Client &client = *loggers.clients[std::size_t(i)];
        const QString &why = client.lastError();
        if (client.isConnected())
            daemons.push_back({addresses->at(i), &client, false, false});
        else
            faults.append(addresses->at(i) + ": " + (why.isEmpty() ? "no answer" : why));
    }
    faults += identify(loggers.members, daemons) + loggers.members.silent;
    if (!arguments.daemons.isEmpty()) {
        loggers.members.silent = faults;
        if (loggers.members.all.empty())
            return Error(ErrorCode::Disconnected, faults.join("; "));
    }
    if (loggers.members.all.empty())
        return Error(
            ErrorCode::Disconnected,
            (QStringList(QString("no logger answers at its default port on %1; --daemons names others")
                             .arg(arguments.host)) +
             loggers.members.silent)
                .join("; "));
    return loggers;
}

} // namespace hermes::ctl
