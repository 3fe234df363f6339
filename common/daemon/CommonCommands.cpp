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
    commands.add(Command("rpc.discover", "This description, an OpenRPC document")
                     .needs(Role::Observer)
                     .answers([&daemon](const Call &) { return daemon.description(); }));
    commands.add(Command("daemon.info", "Who this daemon is")
                     .needs(Role::Observer)
                     .answers([&daemon](const Call &call) { return daemon.info(call.role); }));
    commands.add(Command("daemon.status", "Its state and its health items")
                     .needs(Role::Observer)
                     .answers([&daemon](const Call &) { return daemon.status(); }));
    commands.add(Command("daemon.shutdown", "Ends the daemon in order")
                     .needs(Role::Engineer)
                     .answers([&daemon](const Call &call) {
                         logInfo("daemon", "shutdown asked for by " + call.clientName);
                         QMetaObject::invokeMethod(
                             &daemon, [&daemon] { daemon.shutDown(); }, Qt::QueuedConnection);
                     }));
}

void addProtocolCommand(Daemon &daemon, CommandRegistry &commands) {
    commands.add(
        Command("protocol.use", "After the reply this connection uses another framing in both directions")
            .needs(Role::Observer)
            .param(Field::text("name", "Of the framing").choices(codecNames()))
            .unlisted()
            .answers([&daemon](const Call &call) -> Result<void> {
                Session *session = daemon.server().session(call.client);
                if (!session)
                    return Error(ErrorCode::NotReady, "the client is gone");
                return session->useProtocol(call.text("name"));
            }));
}

Result<SettingsChange> changeReply(Daemon &daemon, const Result<QStringList> &changed) {
    if (!changed)
        return changed.error();
    return SettingsChange{*changed, daemon.settings().needRestart(*changed)};
}

Result<QJsonValue> getSettings(Daemon &daemon, const Call &call) {
    const Settings &settings = daemon.settings();
    const QJsonValue known = valueAt(settings.values(), call.text("path"));
    if (known.isUndefined()) {
        const SchemaViolation unknown{call.text("path"), QJsonValue::Undefined, "the path of a setting"};
        return Error(ErrorCode::InvalidSetting, QString("no setting \"%1\"").arg(call.text("path")),
                     QJsonObject{{"errors", QJsonArray{unknown.toJson()}}});
    }
    if (!call.flag("changes"))
        return known;
    const QJsonValue changed = valueAt(settings.changes(), call.text("path"));
    return changed.isUndefined() ? QJsonValue() : changed;
}

void addSettingsCommands(Daemon &daemon, CommandRegistry &commands) {
    commands.add(Command("settings.schema", "The JSON Schema of the settings")
                     .needs(Role::Observer)
                     .answers([&daemon](const Call &) { return daemon.settings().schema(); }));
    commands.add(Command("settings.get", "All settings, or the value at a path")
                     .needs(Role::Observer)
                     .param(Field::text("path", "Dotted path").byDefault(QString()))
                     .param(Field::boolean("changes", "Only what differs from the defaults").byDefault(false))
                     .example({{"path", "limits.clients"}}, 16)
                     .answers([&daemon](const Call &call) { return getSettings(daemon, call); }));
    commands.add(
        Command("settings.set", "Changes settings: all of the partial object, or nothing")
            .needs(Role::Engineer)
            .param(Field::object("values", "Partial object of settings"))
            .example({{"values", QJsonObject{{"limits", QJsonObject{{"clients", 20}}}}}},
                     QJsonObject{{"changed", QJsonArray{"limits.clients"}}, {"restart", QJsonArray()}})
            .answers([&daemon](const Call &call) {
                return changeReply(daemon, daemon.settings().set(call.value("values").toObject()));
            }));
    commands.add(Command("settings.reset", "Sets settings back to their defaults")
                     .with("x-destructive", "the settings as they are")
                     .needs(Role::Engineer)
                     .param(Field::array("paths", "Dotted paths; none: all settings", schemaOf<QString>())
                                .byDefault(QJsonArray()))
                     .answers([&daemon](const Call &call) {
                         QStringList paths;
                         for (const QJsonValue &path : call.value("paths").toArray())
                             paths.append(path.toString());
                         return changeReply(daemon, daemon.settings().reset(paths));
                     }));
    commands.add(Command("settings.save", "Writes what differs from the defaults to the file of --config")
                     .needs(Role::Engineer)
                     .answers([&daemon](const Call &) -> Result<SavedSettings> {
                         const auto file = daemon.settings().save();
                         if (!file)
                             return file.error();
                         return SavedSettings{*file};
                     }));
}

void addTopicCommands(Daemon &daemon, CommandRegistry &commands, TopicHub &topics) {
    commands.add(Command("topics.list", "The topics and the schemas of their data")
                     .needs(Role::Observer)
                     .answers([&topics](const Call &) { return topics.description(); }));
    commands.add(
        Command("topics.subscribe",
                "Sends a topic to this client as notifications `topic` {subscription, topic, seq, "
                "dropped, stamp, data}")
            .needs(Role::Observer)
            .param(Field::text("topic", "Name of the topic"))
            .param(Field::number("max_rate_hz", "Thin to this rate; 0: every message")
                       .unit("Hz")
                       .range(0, 10000)
                       .byDefault(0))
            .param(Field::integer("queue", "Messages that wait for a slow reader; 1: only the newest")
                       .range(1, 10000)
                       .byDefault(1))
            .example({{"topic", "log"}}, QJsonObject{{"subscription", 1}})
            .answers([&daemon, &topics](const Call &call) -> Result<SubscriptionAnswer> {
                Session *session = daemon.server().session(call.client);
                if (!session)
                    return Error(ErrorCode::NotReady, "the client is gone");
                if (const Role needed = topics.roleFor(call.text("topic")); call.role < needed)
                    return call.notFor("the topic " + call.text("topic"), needed);
                if (session->topics().size() >= maxSubscriptions)
                    return Error(ErrorCode::OverLimit,
                                 QString("a client has at most %1 subscriptions").arg(maxSubscriptions));
                const auto id =
                    topics.subscribe(call.text("topic"), {call.number("max_rate_hz"), call.integer("queue")},
                                     &session->topics());
                if (!id)
                    return id.error();
                return SubscriptionAnswer{*id};
            }));
    commands.add(
        Command("topics.unsubscribe", "Ends a subscription of this client")
            .needs(Role::Observer)
            .param(Field::integer("subscription", "What topics.subscribe gave").range(1, 9007199254740992.0))
            .answers([&daemon, &topics](const Call &call) -> Result<void> {
                Session *session = daemon.server().session(call.client);
                if (!session || !topics.unsubscribe(quint64(call.number("subscription")), &session->topics()))
                    return Error(
                        ErrorCode::NoSuchTopic,
                        QString("no subscription %1 of this client").arg(call.number("subscription")));
                return {};
            }));
}

void addReplayCommand(Daemon &daemon, CommandRegistry &commands, TopicHub &topics) {
    commands.add(
        Command("topics.replay",
                "Shows a recorded message of a topic to its subscribers. Nothing else of this "
                "topic is sent until this client ends that or goes")
            .param(Field::text("topic", "Name of the topic"))
            .param(Field::number("stamp", "When the data were true").unit("s").range(0, 1e10).byDefault(0))
            .param(Field::any("data", "As the topic has them").optional())
            .param(Field::boolean("live",
                                  "Ends it: the topic goes on with what is true now")
                       .byDefault(false))
            .takes(JsonCodec::defaultFrameLimit) // any message, of which the schema checks nothing
            .stream()
            .answers([&daemon, &topics](const Call &call) -> Result<void> {
                Session *session = daemon.server().session(call.client);
                if (!session)
                    return Error(ErrorCode::NotReady, "the client is gone");
                if (!call.flag("live") && !call.has("data"))
                    return invalidParams(
                        {{"data", QJsonValue::Undefined, "a recorded message, or live: true"}});
                return call.flag("live")
                           ? topics.endReplay(call.text("topic"), &session->topics())
                           : topics.replay(call.text("topic"), call.value("data"), call.number("stamp"),
                                           &session->topics(), call.clientName);
            }));
}

} // namespace

void addCommonCommands(Daemon &daemon, CommandRegistry &commands, TopicHub &topics) {
    addDaemonCommands(daemon, commands);
    addSettingsCommands(daemon, commands);
    addTopicCommands(daemon, commands, topics);
    addReplayCommand(daemon, commands, topics);
    addProtocolCommand(daemon, commands);
    commands.add(Command("log.tail", "The last records of the log, oldest first")
                     .needs(Role::Observer)
                     .param(Field::integer("count", "How many; fewer where they "
                                                    "would be larger than 1 MiB")
                                .range(1, 100000)
                                .byDefault(100))
                     .answers([](const Call &call) { return Log::instance().tail(call.integer("count")); }));
    topics.declare(Topic("log", "Each record of the log").carries<LogMessage>());
    topics.declare(Topic("commands", "Each command that changes something or stops, as the audit has it; "
                                     "for engineers")
                       .carries<CommandMessage>()
                       .needs(Role::Engineer));
    topics.declare(Topic("status", "What daemon.status gives, at each change of level")
                       .carries<DaemonStatus>()
                       .snapshot([&daemon] { return daemon.status(); }));
    topics.declare(
        Topic("settings", "All settings, after each change").carries<QJsonObject>().snapshot([&daemon] {
            return QJsonValue(daemon.settings().values());
        }));
}

} // namespace hermes
