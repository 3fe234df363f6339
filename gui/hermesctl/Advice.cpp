#include "gui/hermesctl/Advice.h"

#include "common/Project.h"
#include "common/channel/Channel.h"
#include "common/client/DaemonAddress.h"
#include "common/interface/InterfaceUrl.h"
#include "common/tls/KeyFolder.h"
#include "gui/hermesctl/Descriptions.h"
#include "gui/hermesctl/Nearest.h"
#include "protocol/jsonrpc/Codec.h"

#include <QJsonArray>

namespace hermes::ctl {
namespace {

QJsonObject ofDaemon(Client &client, const Arguments &arguments, const char *method) {
    const auto answer = ask(client, arguments, QLatin1String(method));
    return answer ? answer->toObject() : QJsonObject();
}

/// The first word of the command: which daemon.
QString theDaemon(const Arguments &arguments) {
    return arguments.words.value(0);
}

/// Which program listens at an address by default; "" for none of ours.
QString programAt(const InterfaceUrl &url) {
    for (const QString &name : daemonNames()) {
        if (url.scheme == QStringLiteral("tcp") && url.port == defaultPort(name))
            return QStringLiteral("hermes-") + name;
    }
    return {};
}

QStringList nobodyThere(const Arguments &arguments) {
    const auto address = daemonAddress(theDaemon(arguments), arguments.host);
    const auto url = address ? InterfaceUrl::parse(*address) : address.error();
    if (!url)
        return {};
    if (url->scheme == QStringLiteral("tls")) // there may be one that does not let this client in
        return {QStringLiteral(
                    "the reason is in the log of the daemon; your keys are in %1 ($HERMES_KEYS); hermesctl "
                    "keys list, where they were made, tells which are good")
                    .arg(KeyFolder::usual())};
    const QString program = programAt(*url);
    if (program.isEmpty())
        return {
            QStringLiteral("no daemon listens at %1; one does after: hermes-NAME --listen '%1?protocol=%2'; "
                           "hermesctl list shows those at the default ports")
                .arg(url->toString(), url->protocol())};
    QStringList lines{QStringLiteral("start %1 on %2 (it listens at port %3 by default, on loopback only); "
                                     "one that listens elsewhere is named as HOST:PORT")
                          .arg(program, url->host)
                          .arg(url->port)};
    if (program != QStringLiteral("hermes-supervisor"))
        lines.append(
            QStringLiteral("with a supervisor: hermesctl list says why it does not run, hermesctl call "
                           "supervisor process.output name=%1 what it wrote last, hermesctl call "
                           "supervisor process.start name=%1 starts it")
                .arg(program.mid(int(qstrlen("hermes-")))));
    return lines;
}

/// A port whose peer does not understand the framing says nothing that can be understood here: another
/// framing may be the one.
QStringList otherFraming(const Arguments &arguments) {
    constexpr std::chrono::milliseconds patience{1000};
    const auto address = daemonAddress(theDaemon(arguments), arguments.host);
    const auto url = address ? InterfaceUrl::parse(*address) : address.error();
    if (!url)
        return {};
    for (const QString &framing : codecNames()) {
        if (framing == url->protocol())
            continue;
        const QString other = QStringLiteral("%1?protocol=%2").arg(url->toString(), framing);
        Client client;
        if (!connectOnce(client, other, patience) ||
            !client.callAndWait(QStringLiteral("daemon.info"), QJsonObject(), patience))
            continue;
        return {QStringLiteral("the daemon at %1 speaks %2, and was spoken to in %3; name it as '%4'")
                    .arg(url->toString(), framing, url->protocol(), other)};
    }
    return {
        QStringLiteral("the connection stands, but what is at the other end does not answer: it is busy or "
                       "stopped, or no daemon of Hermes; --timeout S waits longer")};
}

QStringList aboutMethod(Client &client, const Arguments &arguments) {
    const QJsonArray methods =
        ofDaemon(client, arguments, "rpc.discover")[QStringLiteral("methods")].toArray();
    const QStringList near = nearest(arguments.words.value(1), namesOf(methods));
    QStringList lines;
    if (!near.isEmpty())
        lines.append(QStringLiteral("did you mean %1?").arg(near.join(QStringLiteral(" or "))));
    lines.append(QStringLiteral("hermesctl discover %1 lists all").arg(theDaemon(arguments)));
    return lines;
}

/// Of one thing that is wrong: what is expected there, or which name is near one that is not known.
QString aboutPath(const QString &path, const QStringList &names, const QString &whole,
                  const std::function<QJsonObject(const QString &)> &schemaOf) {
    QString known = path;
    while (!known.isEmpty() && !names.contains(known)) // "ports.0.url" is about "ports"
        known = known.section(QLatin1Char('.'), 0, -2);
    const QJsonObject schema = schemaOf(known);
    const QJsonObject members = schema[QStringLiteral("properties")].toObject();
    if (known.isEmpty() || (known != path && !members.isEmpty()))
        return QStringLiteral("%1 is unknown%2; %3").arg(path, didYouMean(path, names), whole);
    return QStringLiteral("%1: %2").arg(
        known, members.isEmpty() ? explanation(schema)
                                 : QStringLiteral("holds %1").arg(members.keys().join(QStringLiteral(", "))));
}

QStringList about(const QJsonValue &errors, const QStringList &names, const QString &whole,
                  const std::function<QJsonObject(const QString &)> &schemaOf) {
    QStringList lines;
    for (const QJsonValue &error : errors.toArray())
        lines.append(aboutPath(error[QStringLiteral("path")].toString(), names, whole, schemaOf));
    lines.removeDuplicates();
    return lines;
}

QStringList aboutParameters(const Error &error, Client &client, const Arguments &arguments) {
    const QJsonArray methods =
        ofDaemon(client, arguments, "rpc.discover")[QStringLiteral("methods")].toArray();
    const QJsonObject method = named(methods, arguments.words.value(1));
    const QStringList names = namesOf(method[QStringLiteral("params")].toArray());
    const QString whole = names.isEmpty() ? QStringLiteral("the command has no parameters")
                                          : QStringLiteral("there is ") + names.join(QStringLiteral(", "));
    return about(error.data[QStringLiteral("errors")], names, whole,
                 [&](const QString &name) { return parameterSchema(method, name); });
}

QStringList aboutSettings(const QJsonValue &errors, Client &client, const Arguments &arguments) {
    const QJsonObject schema = ofDaemon(client, arguments, "settings.schema");
    const QString whole = QStringLiteral("hermesctl get %1 shows all").arg(theDaemon(arguments));
    return about(errors, settingPaths(schema, true), whole,
                 [&](const QString &path) { return settingSchema(schema, path); });
}

QStringList aboutTopic(Client &client, const Arguments &arguments) {
    const auto topics = ask(client, arguments, QStringLiteral("topics.list"));
    const QStringList near =
        topics ? nearest(arguments.words.value(1), namesOf(topics->toArray())) : QStringList();
    return near.isEmpty()
               ? QStringList()
               : QStringList(QStringLiteral("did you mean %1?").arg(near.join(QStringLiteral(" or "))));
}

QStringList aboutControl(const Error &error, const Arguments &arguments) {
    const QJsonValue holder = error.data[QStringLiteral("holder")];
    QStringList lines;
    if (holder.isString())
        lines.append(
            QStringLiteral("%1 holds the control until it calls control.release, disconnects, or sends no "
                           "motion command for the time that it asked for; hermesctl call %2 control.state "
                           "shows it")
                .arg(holder.toString(), theDaemon(arguments)));
    lines.append(QStringLiteral(
        "the control is of one connection, and ends with it: hermesctl drive takes it and keeps "
        "it; a client that drives calls control.acquire first, with take_over=true to take it "
        "from another one; the robot stops then"));
    return lines;
}

} // namespace

QStringList adviceFor(const Error &error, const Arguments &arguments) {
    if (error.is(ErrorCode::Disconnected) && !arguments.words.isEmpty())
        return nobodyThere(arguments);
    return {};
}

QStringList adviceFor(const Error &error, Client &client, const Arguments &arguments) {
    const QString &command = arguments.command;
    const bool isCall = command == QStringLiteral("call");
    if (error.is(ErrorCode::TimedOut))
        return otherFraming(arguments);
    if (error.is(ErrorCode::ControlHeld))
        return aboutControl(error, arguments);
    if (isCall && error.is(ErrorCode::MethodNotFound))
        return aboutMethod(client, arguments);
    if (error.is(ErrorCode::NoSuchTopic) && command == QStringLiteral("watch"))
        return aboutTopic(client, arguments);
    if (error.is(ErrorCode::InvalidSetting))
        return aboutSettings(error.data[QStringLiteral("errors")], client, arguments);
    if (error.is(ErrorCode::InvalidParams) && command == QStringLiteral("get"))
        return aboutSettings(QJsonArray{QJsonObject{{QStringLiteral("path"), arguments.words.value(1)}}},
                             client, arguments);
    if (isCall && error.is(ErrorCode::InvalidParams))
        return aboutParameters(error, client, arguments);
    return {};
}

} // namespace hermes::ctl
