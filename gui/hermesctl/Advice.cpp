#include "gui/hermesctl/Advice.h"

#include "common/Project.h"
#include "common/channel/Channel.h"
#include "common/client/DaemonAddress.h"
#include "common/interface/InterfaceUrl.h"
#include "common/tls/KeyFolder.h"
#include "gui/hermesctl/Descriptions.h"
#include "gui/hermesctl/Nearest.h"
#include "protocol/jsonrpc/Codec.h"

#include <QDir>
#include <QJsonArray>
#include <QSslSocket>

namespace hermes::ctl {
namespace {

constexpr std::chrono::milliseconds adviceTimeout{1000}; // of questions that only explain a failure

QJsonObject ofDaemon(Client &client, const Arguments &arguments, const char *method) {
    const auto answer = ask(client, arguments, method);
    return answer ? answer->toObject() : QJsonObject();
}

/// The first word of the command: which daemon.
QString theDaemon(const Arguments &arguments) {
    return arguments.words.value(0);
}

/// Which program listens at an address by default; "" for none of ours.
QString programAt(const InterfaceUrl &url) {
    for (const QString &name : daemonNames()) {
        if (url.scheme == "tcp" && url.port == defaultPort(name))
            return "hermes-" + name;
    }
    return {};
}

Result<InterfaceUrl> urlOf(const Arguments &arguments) {
    const auto address = daemonAddress(theDaemon(arguments), arguments.host);
    return address ? InterfaceUrl::parse(*address) : address.error();
}

QString placeOf(const InterfaceUrl &url) {
    return url.toString().section("//", 1);
}

bool speaksTls(const InterfaceUrl &url) {
    QSslSocket socket;
    socket.setPeerVerifyMode(QSslSocket::VerifyNone);
    socket.connectToHostEncrypted(url.host, url.port);
    return socket.waitForEncrypted(int(adviceTimeout.count()));
}

bool answersAt(const QString &address) {
    Client client;
    return connectOnce(client, address, adviceTimeout) &&
           client.callAndWait("daemon.info", QJsonObject(), adviceTimeout);
}

/// Why a daemon and this client have not come to terms over TLS.
QStringList aboutTls(const Error &error, const InterfaceUrl &url) {
    const QString keys = url.option("keys", KeyFolder::usual());
    if (error.message.contains("not accepted"))
        return {
            QString("its keys and yours in %1 are of different authorities, or its keys have expired; one "
                    "authority must issue both (hermesctl keys issue), and HERMES_KEYS=FOLDER chooses yours")
                .arg(keys)};
    if (error.message.contains("SSL") && answersAt(placeOf(url))) // in the usual framing
        return {QString("the daemon there speaks plain text, no TLS; name it as %1").arg(placeOf(url))};
    if (!error.message.contains("closed by the peer"))
        return {};
    return {QString("the daemon refuses your keys in %1: they may be revoked, expired, or of another "
                    "authority; its log tells which")
                .arg(keys),
            "hermesctl keys list, where they were made, tells which are good; hermesctl keys issue makes new "
            "ones"};
}

/// Why a connection has ended before its reply.
QStringList wasClosed(const Error &error, const Arguments &arguments) {
    const auto url = urlOf(arguments);
    if (url && url->scheme == "tls")
        return aboutTls(error, *url);
    if (url && url->scheme == "tcp" && speaksTls(*url))
        return {
            QString(
                "the port is one for TLS; name the daemon as tls://%1; your keys are in %2 ($HERMES_KEYS)")
                .arg(placeOf(*url), KeyFolder::usual())};
    return {};
}

QStringList nobodyThere(const Error &error, const Arguments &arguments) {
    const auto url = urlOf(arguments);
    if (!url)
        return {};
    if (error.message.contains("Host not found"))
        return {QString("this computer knows no host \"%1\": check the name, or give the IP address")
                    .arg(url->host)};
    const bool isRefused = error.message.contains("Connection refused");
    if (url->scheme == "tcp" && !isRefused)
        return {QString("this computer does not reach %1: are both in the same network (ip address, ping "
                        "%1)? A firewall there may also drop what comes to port %2")
                    .arg(url->host)
                    .arg(url->port)};
    if (url->scheme == "tls" && !isRefused) // somebody listens, or keys are missing here
        return aboutTls(error, *url);
    const QString program = programAt(*url);
    if (program.isEmpty())
        return {QString("no daemon listens at %1; start one there: hermes-NAME --listen '%1?protocol=%2'; "
                        "hermesctl list shows those at the default ports")
                    .arg(url->toString(), url->protocol())};
    QStringList lines{QString("start %1 on %2 (it listens at port %3 by default, on loopback only); one that "
                              "listens elsewhere is named as HOST:PORT")
                          .arg(program, url->host)
                          .arg(url->port)};
    if (program != "hermes-supervisor")
        lines.append(QString("with a supervisor: hermesctl list says why it does not run, hermesctl call "
                             "supervisor process.output name=%1 what it wrote last, hermesctl call "
                             "supervisor process.start name=%1 starts it")
                         .arg(program.mid(int(qstrlen("hermes-")))));
    return lines;
}

/// A port whose peer does not understand the framing says nothing that can be understood here: another
/// framing may be the one.
QStringList otherFraming(const Arguments &arguments) {
    const auto url = urlOf(arguments);
    if (!url)
        return {};
    for (const QString &framing : codecNames()) {
        if (framing == url->protocol())
            continue;
        const QString other = QString("%1?protocol=%2").arg(url->toString(), framing);
        if (answersAt(other))
            return {QString("the daemon at %1 speaks %2, and was spoken to in %3; name it as '%4'")
                        .arg(url->toString(), framing, url->protocol(), other)};
    }
    return {"the connection is open, but what is at the other end does not answer: it is busy or stopped, or "
            "is no daemon of Hermes; --timeout S waits longer"};
}

/// Of the word after the daemon, in a list of what it has.
QStringList aboutName(const QJsonArray &list, const Arguments &arguments) {
    const QStringList near = nearest(arguments.words.value(1), namesOf(list));
    return near.isEmpty() ? QStringList() : QStringList(QString("did you mean %1?").arg(near.join(" or ")));
}

QStringList aboutMethod(Client &client, const Arguments &arguments) {
    return aboutName(ofDaemon(client, arguments, "rpc.discover")["methods"].toArray(), arguments)
           << QString("hermesctl discover %1 lists all").arg(theDaemon(arguments));
}

/// Below a schema: a member, or any element of a list.
QJsonObject below(const QJsonObject &schema, const QString &key) {
    const QJsonObject member = schema["properties"].toObject()[key].toObject();
    return member.isEmpty() ? schema["items"].toObject() : member;
}

QStringList withPrefix(const QString &prefix, QStringList names) {
    for (QString &name : names)
        name.prepend(prefix);
    return names;
}

/// Of one thing that is wrong: what is expected there, or which name is near one that is not known. whole
/// tells what there is at all.
QString aboutPath(const QString &path, const QJsonObject &root, const QString &whole) {
    QJsonObject schema = root;
    QString known; // as far as the path is
    for (const QString &key : path.split('.')) {
        const QJsonObject next = below(schema, key);
        const QStringList members = schema["properties"].toObject().keys();
        if (next.isEmpty() && members.isEmpty()) // may hold anything
            break;
        const QString before = known.isEmpty() ? QString() : known + '.';
        if (next.isEmpty() && known.isEmpty())
            return QString("%1 is unknown%2; %3")
                .arg(path, didYouMean(path, settingPaths(root, true)), whole);
        if (next.isEmpty())
            return QString("%1 is unknown%2; %3 holds %4")
                .arg(path, didYouMean(path, withPrefix(before, members)), known, members.join(", "));
        schema = next;
        known = before + key;
    }
    const QStringList members = schema["properties"].toObject().keys();
    return QString("%1: %2").arg(known, members.isEmpty() ? explanation(schema)
                                                          : QString("holds %1").arg(members.join(", ")));
}

QStringList about(const QJsonValue &errors, const QJsonObject &root, const QString &whole) {
    QStringList lines;
    for (const QJsonValue &error : errors.toArray())
        lines.append(aboutPath(error["path"].toString(), root, whole));
    lines.removeDuplicates();
    return lines;
}

QStringList aboutParameters(const Error &error, Client &client, const Arguments &arguments) {
    const QJsonArray methods = ofDaemon(client, arguments, "rpc.discover")["methods"].toArray();
    const QJsonObject method = named(methods, arguments.words.value(1));
    const QStringList names = namesOf(method["params"].toArray());
    const QString whole = names.isEmpty() ? "the command has no parameters" : "there is " + names.join(", ");
    return about(error.data["errors"], parametersSchema(method), whole);
}

QStringList aboutSettings(const QJsonValue &errors, Client &client, const Arguments &arguments) {
    const QJsonObject schema = ofDaemon(client, arguments, "settings.schema");
    return about(errors, schema, QString("hermesctl get %1 shows all").arg(theDaemon(arguments)));
}

QStringList aboutTopic(Client &client, const Arguments &arguments) {
    const auto topics = ask(client, arguments, "topics.list");
    return topics ? aboutName(topics->toArray(), arguments) : QStringList();
}

QStringList aboutControl(const Error &error, const Arguments &arguments) {
    const QJsonValue holder = error.data["holder"];
    QStringList lines;
    if (holder.isString())
        lines.append(
            QString("%1 holds the control until it calls control.release, disconnects, or sends no motion "
                    "command for the time that it asked for; hermesctl call %2 control.state shows it")
                .arg(holder.toString(), theDaemon(arguments)));
    if (arguments.command != "drive")
        lines.append("the control belongs to one connection, and ends with it: hermesctl drive takes it and "
                     "keeps it; a client that drives calls control.acquire first, with take_over=true to "
                     "take it from another one; the robot stops then");
    return lines;
}

/// A daemon looks for a relative path in its own folder, which is seldom the one of the caller.
QStringList aboutFiles(const Error &error, const Arguments &arguments) {
    QStringList lines;
    for (const QString &word : arguments.words.mid(2)) {
        const QString name = word.section('=', 0, 0), path = word.section('=', 1);
        const QString here = QFileInfo(path).absoluteFilePath();
        if (!path.isEmpty() && QDir::isRelativePath(path) && QFileInfo::exists(here) &&
            error.data["path"].toString() != here)
            lines.append(
                QString(
                    "a relative path begins in the folder of the daemon; for the file in this folder: %1=%2")
                    .arg(name, here));
    }
    return lines;
}

} // namespace

QStringList adviceFor(const Error &error, const Arguments &arguments) {
    if (error.is(ErrorCode::Disconnected) && !arguments.words.isEmpty())
        return nobodyThere(error, arguments);
    return {};
}

QStringList adviceFor(const Error &error, Client &client, const Arguments &arguments) {
    const QString &command = arguments.command;
    const bool isCall = command == "call";
    if (error.is(ErrorCode::TimedOut)) {
        if (!client.callAndWait("daemon.info", QJsonObject(), adviceTimeout))
            return otherFraming(arguments);
        return arguments.timeoutIsGiven && isCall
                   ? QStringList("the daemon answers other requests: this one takes longer; without "
                                 "--timeout hermesctl waits for it")
                   : QStringList();
    }
    if (error.is(ErrorCode::Disconnected))
        return wasClosed(error, arguments);
    if (error.is(ErrorCode::ControlHeld))
        return aboutControl(error, arguments);
    if (command == "session remove" && error.data["confirm"].toBool())
        return {"--yes removes it"};
    if (command == "drive" && error.is(ErrorCode::MethodNotFound))
        return {QString("%1 drives no robot; hermes-motorcontrol does").arg(theDaemon(arguments))};
    if (isCall && error.is(ErrorCode::MethodNotFound))
        return aboutMethod(client, arguments);
    if (error.is(ErrorCode::NoSuchTopic) && command == "watch")
        return aboutTopic(client, arguments);
    if (error.is(ErrorCode::InvalidSetting))
        return aboutSettings(error.data["errors"], client, arguments);
    if (error.is(ErrorCode::InvalidParams) && command == "get")
        return aboutSettings(QJsonArray{QJsonObject{{"path", arguments.words.value(1)}}}, client, arguments);
    if (isCall && error.is(ErrorCode::InputOutput))
        return aboutFiles(error, arguments);
    if (isCall && error.is(ErrorCode::InvalidParams))
        return aboutParameters(error, client, arguments);
    return {};
}

} // namespace hermes::ctl
