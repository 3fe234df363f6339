#include "common/daemon/CommonCommands.h"

#include "common/Log.h"
#include "common/Time.h"
#include "common/daemon/Daemon.h"
#include "common/settings/DottedPath.h"
#include "protocol/jsonrpc/JsonCodec.h"
#include "protocol/wire/Fields.h"

namespace hermes {
namespace {

constexpr std::size_t maxSubscriptions = 100; // of a client

void addDaemonCommands(Daemon &daemon, CommandRegistry &commands) {
    commands.add(
        Command(QStringLiteral("rpc.discover"), QStringLiteral("This description, an OpenRPC document"))
            .needs(Role::Observer)
            .gives<QJsonObject>()
            .handler([&daemon](const Call &) { return QJsonValue(daemon.description()); }));
    commands.add(Command(QStringLiteral("daemon.info"), QStringLiteral("Who this daemon is"))
                     .needs(Role::Observer)
                     .gives<DaemonInfo>()
                     .handler([&daemon](const Call &call) { return asJson(daemon.info(call.role)); }));
    commands.add(Command(QStringLiteral("daemon.status"), QStringLiteral("Its state and its health items"))
                     .needs(Role::Observer)
                     .gives<DaemonStatus>()
                     .handler([&daemon](const Call &) { return asJson(daemon.status()); }));
    commands.add(Command(QStringLiteral("daemon.shutdown"), QStringLiteral("Ends the daemon in order"))
                     .needs(Role::Engineer)
                     .returnsNull()
                     .handler([&daemon](const Call &call) {
                         logInfo(QStringLiteral("daemon"),
                                 QStringLiteral("shutdown asked for by ") + call.clientName);
                         QMetaObject::invokeMethod(
                             &daemon, [&daemon] { daemon.shutDown(); }, Qt::QueuedConnection);
                         return QJsonValue();
                     }));
}

void addProtocolCommand(Daemon &daemon, CommandRegistry &commands) {
    commands.add(
        Command(QStringLiteral("protocol.use"),
                QStringLiteral("After the reply this connection uses another framing in both directions"))
            .needs(Role::Observer)
            .param(
                Field::text(QStringLiteral("name"), QStringLiteral("Of the framing")).choices(codecNames()))
            .returnsNull()
            .unlisted()
            .handler([&daemon](const Call &call) -> Result<QJsonValue> {
                Session *session = daemon.server().session(call.client);
                if (!session)
                    return Error(ErrorCode::NotReady, QStringLiteral("the client is gone"));
                const Result<void> agreed = session->useProtocol(call.text("name"));
                return agreed ? Result<QJsonValue>(QJsonValue()) : agreed.error();
            }));
}

QJsonValue changeReply(Daemon &daemon, const QStringList &paths) {
    return asJson(SettingsChange{paths, daemon.settings().needRestart(paths)});
}

Result<QJsonValue> getSettings(Daemon &daemon, const Call &call) {
    const Settings &settings = daemon.settings();
    const QJsonValue known = valueAt(settings.values(), call.text("path"));
    if (known.isUndefined()) {
        const SchemaViolation unknown{call.text("path"), QJsonValue::Undefined,
                                      QStringLiteral("the path of a setting")};
        return Error(ErrorCode::InvalidSetting, QStringLiteral("no setting \"%1\"").arg(call.text("path")),
                     QJsonObject{{QStringLiteral("errors"), QJsonArray{unknown.toJson()}}});
    }
    if (!call.flag("changes"))
        return known;
    const QJsonValue changed = valueAt(settings.changes(), call.text("path"));
    return changed.isUndefined() ? QJsonValue() : changed;
}

void addSettingsCommands(Daemon &daemon, CommandRegistry &commands) {
    commands.add(Command(QStringLiteral("settings.schema"), QStringLiteral("The JSON Schema of the settings"))
                     .needs(Role::Observer)
                     .gives<QJsonObject>()
                     .handler([&daemon](const Call &) { return QJsonValue(daemon.settings().schema()); }));
    commands.add(
        Command(QStringLiteral("settings.get"), QStringLiteral("All settings, or the value at a path"))
            .needs(Role::Observer)
            .param(Field::text(QStringLiteral("path"), QStringLiteral("Dotted path")).byDefault(QString()))
            .param(Field::boolean(QStringLiteral("changes"),
                                  QStringLiteral("Only what differs from the defaults"))
                       .byDefault(false))
            .gives<QJsonValue>()
            .example({{QStringLiteral("path"), QStringLiteral("limits.clients")}}, 16)
            .handler([&daemon](const Call &call) { return getSettings(daemon, call); }));
    commands.add(
        Command(QStringLiteral("settings.set"),
                QStringLiteral("Changes settings: all of the partial object, or nothing"))
            .needs(Role::Engineer)
            .param(Field::object(QStringLiteral("values"), QStringLiteral("Partial object of settings")))
            .gives<SettingsChange>()
            .example(
                {{QStringLiteral("values"),
                  QJsonObject{{QStringLiteral("limits"), QJsonObject{{QStringLiteral("clients"), 20}}}}}},
                QJsonObject{{QStringLiteral("changed"), QJsonArray{QStringLiteral("limits.clients")}},
                            {QStringLiteral("restart"), QJsonArray()}})
            .handler([&daemon](const Call &call) -> Result<QJsonValue> {
                const auto changed = daemon.settings().set(call.value("values").toObject());
                if (!changed)
                    return changed.error();
                return changeReply(daemon, *changed);
            }));
    commands.add(
        Command(QStringLiteral("settings.reset"), QStringLiteral("Sets settings back to their defaults"))
            .with(QStringLiteral("x-destructive"), QStringLiteral("the settings as they are"))
            .needs(Role::Engineer)
            .param(Field::array(QStringLiteral("paths"), QStringLiteral("Dotted paths; none: all settings"),
                                schemaOf<QString>())
                       .byDefault(QJsonArray()))
            .gives<SettingsChange>()
            .handler([&daemon](const Call &call) -> Result<QJsonValue> {
                QStringList paths;
                for (const QJsonValue &path : call.value("paths").toArray())
                    paths.append(path.toString());
                const auto changed = daemon.settings().reset(paths);
                if (!changed)
                    return changed.error();
                return changeReply(daemon, *changed);
            }));
    commands.add(Command(QStringLiteral("settings.save"),
                         QStringLiteral("Writes what differs from the defaults to the file of --config"))
                     .needs(Role::Engineer)
                     .gives<SavedSettings>()
                     .handler([&daemon](const Call &) -> Result<QJsonValue> {
                         const auto file = daemon.settings().save();
                         if (!file)
                             return file.error();
                         return asJson(SavedSettings{*file});
                     }));
}

void addTopicCommands(Daemon &daemon, CommandRegistry &commands, TopicHub &topics) {
    commands.add(
        Command(QStringLiteral("topics.list"), QStringLiteral("The topics and the schemas of their data"))
            .needs(Role::Observer)
            .gives<std::vector<TopicDescription>>()
            .handler([&topics](const Call &) { return asJson(topics.description()); }));
    commands.add(
        Command(
            QStringLiteral("topics.subscribe"),
            QStringLiteral("Sends a topic to this client as notifications `topic` {subscription, topic, seq, "
                           "dropped, stamp, data}"))
            .needs(Role::Observer)
            .param(Field::text(QStringLiteral("topic"), QStringLiteral("Name of the topic")))
            .param(Field::number(QStringLiteral("max_rate_hz"),
                                 QStringLiteral("Thin to this rate; 0: every message"))
                       .unit(QStringLiteral("Hz"))
                       .range(0, 10000)
                       .byDefault(0))
            .param(Field::integer(QStringLiteral("queue"),
                                  QStringLiteral("Messages that wait for a slow reader; 1: only the newest"))
                       .range(1, 10000)
                       .byDefault(1))
            .gives<SubscriptionAnswer>()
            .example({{QStringLiteral("topic"), QStringLiteral("log")}},
                     QJsonObject{{QStringLiteral("subscription"), 1}})
            .handler([&daemon, &topics](const Call &call) -> Result<QJsonValue> {
                Session *session = daemon.server().session(call.client);
                if (!session)
                    return Error(ErrorCode::NotReady, QStringLiteral("the client is gone"));
                if (const Role needed = topics.roleFor(call.text("topic")); call.role < needed)
                    return call.notFor(QStringLiteral("the topic ") + call.text("topic"), needed);
                if (session->topics().size() >= maxSubscriptions)
                    return Error(
                        ErrorCode::OverLimit,
                        QStringLiteral("a client has at most %1 subscriptions").arg(maxSubscriptions));
                const auto id =
                    topics.subscribe(call.text("topic"), {call.number("max_rate_hz"), call.integer("queue")},
                                     &session->topics());
                if (!id)
                    return id.error();
                return asJson(SubscriptionAnswer{*id});
            }));
    commands.add(
        Command(QStringLiteral("topics.unsubscribe"), QStringLiteral("Ends a subscription of this client"))
            .needs(Role::Observer)
            .param(
                Field::integer(QStringLiteral("subscription"), QStringLiteral("What topics.subscribe gave"))
                    .range(1, 9007199254740992.0))
            .returnsNull()
            .handler([&daemon, &topics](const Call &call) -> Result<QJsonValue> {
                Session *session = daemon.server().session(call.client);
                if (!session || !topics.unsubscribe(quint64(call.number("subscription")), &session->topics()))
                    return Error(
                        ErrorCode::NoSuchTopic,
                        QStringLiteral("no subscription %1 of this client").arg(call.number("subscription")));
                return QJsonValue();
            }));
}

void addReplayCommand(Daemon &daemon, CommandRegistry &commands, TopicHub &topics) {
    commands.add(
        Command(QStringLiteral("topics.replay"),
                QStringLiteral("Shows a recorded message of a topic to its subscribers. Nothing else of this "
                               "topic is sent until this client ends that or goes"))
            .param(Field::text(QStringLiteral("topic"), QStringLiteral("Name of the topic")))
            .param(Field::number(QStringLiteral("stamp"), QStringLiteral("When the data were true"))
                       .unit(QStringLiteral("s"))
                       .range(0, 1e10)
                       .byDefault(0))
            .param(Field::any(QStringLiteral("data"), QStringLiteral("As the topic has them")).optional())
            .param(Field::boolean(QStringLiteral("live"),
                                  QStringLiteral("Ends it: the topic goes on with what is true now"))
                       .byDefault(false))
            .takes(JsonCodec::defaultFrameLimit) // any message, of which the schema checks nothing
            .stream()
            .returnsNull()
            .handler([&daemon, &topics](const Call &call) -> Result<QJsonValue> {
                Session *session = daemon.server().session(call.client);
                if (!session)
                    return Error(ErrorCode::NotReady, QStringLiteral("the client is gone"));
                if (!call.flag("live") && !call.has("data"))
                    return invalidParams({{QStringLiteral("data"), QJsonValue::Undefined,
                                           QStringLiteral("a recorded message, or live: true")}});
                const Result<void> done =
                    call.flag("live")
                        ? topics.endReplay(call.text("topic"), &session->topics())
                        : topics.replay(call.text("topic"), call.value("data"), call.number("stamp"),
                                        &session->topics(), call.clientName);
                return done ? Result<QJsonValue>(QJsonValue()) : done.error();
            }));
}

} // namespace

void addCommonCommands(Daemon &daemon, CommandRegistry &commands, TopicHub &topics) {
    addDaemonCommands(daemon, commands);
    addSettingsCommands(daemon, commands);
    addTopicCommands(daemon, commands, topics);
    addReplayCommand(daemon, commands, topics);
    addProtocolCommand(daemon, commands);
    commands.add(
        Command(QStringLiteral("log.tail"), QStringLiteral("The last records of the log, oldest first"))
            .needs(Role::Observer)
            .param(Field::integer(QStringLiteral("count"), QStringLiteral("How many; fewer where they "
                                                                          "would be larger than 1 MiB"))
                       .range(1, 100000)
                       .byDefault(100))
            .gives<std::vector<LogMessage>>()
            .handler([](const Call &call) { return asJson(Log::instance().tail(call.integer("count"))); }));
    topics.declare(
        Topic(QStringLiteral("log"), QStringLiteral("Each record of the log")).carries<LogMessage>());
    topics.declare(Topic(QStringLiteral("commands"),
                         QStringLiteral("Each command that changes something or stops, as the audit has it; "
                                        "for engineers"))
                       .carries<CommandMessage>()
                       .needs(Role::Engineer));
    topics.declare(
        Topic(QStringLiteral("status"), QStringLiteral("What daemon.status gives, at each change of level"))
            .carries<DaemonStatus>()
            .snapshot([&daemon] { return daemon.status(); }));
    topics.declare(Topic(QStringLiteral("settings"), QStringLiteral("All settings, after each change"))
                       .carries<QJsonObject>()
                       .snapshot([&daemon] { return QJsonValue(daemon.settings().values()); }));
}

} // namespace hermes
