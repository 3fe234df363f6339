#include "daemons/web/Web.h"

#include "common/Log.h"
#include "common/OwnRobot.h"
#include "common/Project.h"
#include "common/client/DaemonAddress.h"
#include "common/interface/InterfaceRegistry.h"
#include "common/interface/SocketOwner.h"
#include "common/settings/SettingsTable.h"

#include <QFile>
#include <QUuid>
#include <QWebSocket>

namespace hermes::web {
namespace {

constexpr quint16 commandPort = 7475;
constexpr int strangers = 16; // connections that are no client yet
constexpr std::chrono::seconds alivePeriod{60};
constexpr double longestGap_s = 0.25; // after which what a panel wished before is void

// Foxglove, Lichtblick from its container, and the desktop programs of both, which are made with Electron.
const QJsonArray usualOrigins{"https://app.foxglove.dev", "http://localhost:8080", "file://"};

QByteArray resource(const char *name) {
    QFile file(QString(":/web/") + name);
    file.open(QIODevice::ReadOnly);
    return file.readAll();
}

Peer peerOf(const QWebSocket &socket) {
    const QHostAddress theirs = socket.peerAddress(), ours = socket.localAddress();
    const auto user = ownerOfSocket({theirs, socket.peerPort()}, {ours, socket.localPort()});
    if (user || theirs.isLoopback() || theirs == ours) // as TcpInterface::peer()
        return {Peer::Place::Computer, user};
    return {};
}

std::vector<SchemaViolation> wrongWeb(const QJsonObject &values) {
    const QJsonValue listen = values["web"]["listen"];
    const Result<InterfaceUrl> url = InterfaceUrl::parse(listen.toString());
    if (!url || url->scheme != "tcp" || QHostAddress(url->host).isNull())
        return {{"web.listen", listen, "ADDRESS:PORT, as 127.0.0.1:8765"}};
    const bool mayCommand = roleFrom(values["web"]["role"].toString()) > Role::Observer;
    if (isOpenToNetwork(*url) && mayCommand && !values["insecure"].toBool())
        return {
            {"web.listen", listen,
             "an address that only this computer reaches, as 127.0.0.1: with web.role others on the network "
             "could command the robot in plain text; \"insecure\": true accepts that"}};
    return {};
}

} // namespace

Web::Web()
    : Daemon(
          {"web", "Web",
           "Shows the robot in a browser: to Foxglove and Lichtblick over their WebSocket protocol, and on "
           "a page of its own",
           commandPort})
    , robot_(ownRobot().value_or(RobotIdentity()).id)
    , hall_{robot_, server().gaps(), {}, QUuid::createUuid().toString(QUuid::WithoutBraces)} {
    const QString robot = ownRobot().value_or(RobotIdentity()).name;
    hall_.name = robot.isEmpty() ? QString("Hermes") : "Hermes: " + robot;
    declareSettings();
    connect(&robot_.daemons(), &RobotDaemons::missed, this,
            [](const QString &line) { logWarning("daemons", line); });
    connect(&alive_, &QTimer::timeout, this, [this] {
        const auto all = clients_;
        for (WebClient *client : all)
            client->checkAlive();
    });
}

Web::~Web() {
    stop();
}

void Web::declareSettings() {
    SettingsTable table;
    table.group("Robot");
    table
        .defineList("daemons",
                    "The daemons of the robot, by name, HOST:PORT or URL; none: those at the default "
                    "ports of this host. Those that a supervisor among them starts are known, too",
                    {{"type", "string"}})
        .with("maxItems", 100);
    table.group("Web", SettingsTable::Applies::OnRestart);
    table.define(
        "web.listen", "127.0.0.1:8765",
        "Address and port for browsers; who reaches them may see all that the robot tells, and stop it");
    table
        .define("web.role", toString(Role::Observer),
                "What web clients may do; programs of other users of this computer are observers always")
        .choices(roleNames());
    table
        .defineList("web.origins", "Web pages that may connect beside the daemon's own, as https://HOST:PORT",
                    {{"type", "string"}})
        .byDefault(usualOrigins)
        .with("maxItems", 100);
    table.define("web.clients", 32, "Web clients at the same time").range(1, 1000);
    table.define("web.release_s", 1.2,
                 "A teleop panel that tells nothing for so long was let go: the robot stops. More than the "
                 "period at which it publishes",
                 "s", 0.1, 5);
    table.declareIn(settings());
    settings().addRule(wrongWeb);
}

Result<void> Web::start() {
    server().gaps().watch(longestGap_s);
    hall_.deadMan_s = settings().number("web.release_s");
    const QMap<QByteArray, Door::Document> documents{
        {"/", {"text/html; charset=utf-8", resource("page.html")}},
        {"/layout.json", {"application/json", resource("layout.json")}}};
    const auto url = InterfaceUrl::parse(settings().text("web.listen"));
    door_ =
        std::make_unique<Door>(*url, documents, settings().value("web.origins").toVariant().toStringList(),
                               settings().integer("web.clients") + strangers, nullptr);
    if (const Result<void> listening = door_->listen(); !listening)
        return listening;
    connect(door_.get(), &Door::entered, this, &Web::enter);
    logInfo("web", "http" + door_->address().mid(3) + " for browsers, as " + settings().text("web.role"));
    alive_.start(alivePeriod);
    for (const char *item : {"web", "daemons", "topics"})
        health().provide(item, [this] { updateHealth(); });
    follow();
    setState(DaemonState::Running);
    return {};
}

void Web::stop() {
    alive_.stop();
    const auto all = std::exchange(clients_, {});
    for (WebClient *client : all)
        delete client;
    door_.reset(); // has the connections of them all
}

void Web::settingsChanged(const QStringList &paths) {
    if (paths.contains("daemons"))
        follow();
}

void Web::follow() {
    QStringList addresses;
    for (const QString &one : settings().value("daemons").toVariant().toStringList())
        if (const Result<QString> address = daemonAddress(one))
            addresses.append(*address);
        else
            logWarning("daemons", address.error().message);
    if (addresses.isEmpty())
        for (const QString &name : daemonNames())
            addresses.append(*daemonAddress(name));
    robot_.daemons().follow(addresses);
}

void Web::enter(QWebSocket *socket) {
    if (int(clients_.size()) >= settings().integer("web.clients")) {
        ++turnedAway_;
        connect(socket, &QWebSocket::disconnected, socket, &QObject::deleteLater);
        QTimer::singleShot(std::chrono::seconds(5), socket, [socket] { socket->abort(); });
        return socket->close(QWebSocketProtocol::CloseCodePolicyViolated, "too many clients (web.clients)");
    }
    const Role role = roleFrom(settings().text("web.role")).value_or(Role::Observer);
    auto *const client = new WebClient(socket, roleOf(peerOf(*socket), {role, Role::Observer}), hall_, this);
    clients_.insert(client);
    connect(client, &WebClient::gone, this, [this, client] {
        if (clients_.erase(client) > 0)
            client->deleteLater();
    });
}

void Web::updateHealth() {
    const quint64 refused = (door_ ? door_->refused() : 0) + turnedAway_;
    health().set("web", HealthLevel::Ok,
                 QString("%1 web clients, %2").arg(clients_.size()).arg(settings().text("web.role")),
                 {{"clients", int(clients_.size())},
                  {"refused", double(refused)},
                  {"last_refusal", door_ ? door_->lastRefusal() : QString()},
                  {"dropped", double(hall_.dropped)},
                  {"bad_frames", double(hall_.bad)}});
    const QStringList silent = robot_.daemons().silent(), problems = robot_.problems();
    health().set("daemons", silent.isEmpty() ? HealthLevel::Ok : HealthLevel::Warn,
                 silent.isEmpty() ? "those that were found answer" : "no answer from " + silent.join(", "));
    health().set("topics", problems.isEmpty() ? HealthLevel::Ok : HealthLevel::Warn,
                 problems.isEmpty() ? "all that comes can be read" : problems.join("; "));
}

} // namespace hermes::web
