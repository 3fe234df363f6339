#include "common/Log.h"
#include "common/daemon/Daemon.h"
#include "common/interface/InterfaceRegistry.h"
#include "protocol/jsonrpc/Codec.h"

namespace hermes {
namespace {

const QStringList levels{QStringLiteral("debug"), QStringLiteral("info"), QStringLiteral("warning"),
                         QStringLiteral("error")};

// What is wrong with an address to listen at; nothing: empty.
QString wrongListen(const QString &text, bool fromNetwork) {
    const auto url = InterfaceUrl::parse(text);
    if (!url)
        return QStringLiteral("a URL like tcp://127.0.0.1:7410?protocol=json");
    if (!interfaceSchemes().contains(url->scheme))
        return QStringLiteral("one of the schemes ") + interfaceSchemes().join(QStringLiteral(", "));
    if (!codecNames().contains(url->protocol()))
        return QStringLiteral("one of the protocols ") + codecNames().join(QStringLiteral(", "));
    if (isOpenToNetwork(*url) && !fromNetwork)
        return QStringLiteral(
            "an address that only this computer reaches, as 127.0.0.1: in plain text others on "
            "the network could command this daemon; \"insecure\": true accepts that "
            "(--set insecure=true)");
    return {};
}

// With addresses that cannot work the daemon would not start again.
std::vector<SchemaViolation> checkListen(const QJsonObject &settings, bool fromNetwork) {
    const QJsonArray listen = settings.value(QStringLiteral("listen")).toArray();
    std::vector<SchemaViolation> wrong;
    for (int i = 0; i < listen.size(); ++i) {
        const QString expected = wrongListen(listen.at(i).toString(), fromNetwork);
        if (!expected.isEmpty())
            wrong.push_back({QStringLiteral("listen.%1").arg(i), listen.at(i), expected});
    }
    return wrong;
}

} // namespace

// The settings that every daemon has.
void Daemon::declareCommonSettings() {
    const QString channelGroup = QStringLiteral("Channels");
    const QString limitGroup = QStringLiteral("Limits");
    const QString logGroup = QStringLiteral("Log");
    const QString address = QStringLiteral("tcp://127.0.0.1:%1?protocol=json").arg(self_.port);
    addSetting(Field::array(QStringLiteral("listen"), QStringLiteral("URLs at which commands are accepted"),
                            {{QStringLiteral("type"), QStringLiteral("string")}})
                   .with(QStringLiteral("minItems"), 1)
                   .group(channelGroup)
                   .byDefault(QJsonArray{address})
                   .appliesOnRestart());
    configuration_.addRule([this](const QJsonObject &settings) {
        // At the start launch() says it, when all settings are known.
        return checkListen(settings, !launched_ || settings.value(QStringLiteral("insecure")).toBool());
    });
    addSetting(Field::boolean(
                   QStringLiteral("insecure"),
                   QStringLiteral("Accept commands in plain text from the network, not only from this host"))
                   .group(channelGroup)
                   .byDefault(false)
                   .appliesOnRestart());
    addSetting(
        Field::text(QStringLiteral("access.plain"),
                    QStringLiteral("Role of clients without a certificate: programs of the daemon's own user "
                                   "over TCP, lines, UDP, and the network where insecure is true"))
            .choices(roleNames())
            .group(channelGroup)
            .byDefault(toString(Role::Operator)));
    addSetting(Field::text(QStringLiteral("access.others"),
                           QStringLiteral("Role of programs of other users of this computer"))
                   .choices(roleNames())
                   .group(channelGroup)
                   .byDefault(toString(Role::Observer)));
    addSetting(Field::boolean(QStringLiteral("audit.on"),
                              QStringLiteral("Write an audit of who commands what: a line of JSON for each "
                                             "command that changes something"))
                   .group(logGroup)
                   .byDefault(true)
                   .appliesOnRestart());
    addSetting(Field::text(
                   QStringLiteral("audit.folder"),
                   QStringLiteral(
                       "Folder of the audit; empty: audit in the state folder of the service or of the user"))
                   .group(logGroup)
                   .byDefault(QString())
                   .appliesOnRestart());
    addSetting(Field::integer(QStringLiteral("audit.file_bytes"),
                              QStringLiteral("Size of an audit file; then a new one begins"))
                   .unit(QStringLiteral("B"))
                   .range(4096, 1 << 30)
                   .group(logGroup)
                   .byDefault(1 << 20)
                   .appliesOnRestart());
    addSetting(Field::integer(QStringLiteral("audit.files"), QStringLiteral("Audit files that are kept"))
                   .range(1, 1000)
                   .group(logGroup)
                   .byDefault(5)
                   .appliesOnRestart());
    addSetting(Field::integer(QStringLiteral("limits.frame_bytes"),
                              QStringLiteral("Largest request of a new client"))
                   .unit(QStringLiteral("B"))
                   .range(1024, 64 << 20)
                   .group(limitGroup)
                   .byDefault(1 << 20));
    addSetting(
        Field::integer(QStringLiteral("limits.topic_bytes"),
                       QStringLiteral("Unsent topic data of a new client; beyond it the oldest is dropped"))
            .unit(QStringLiteral("B"))
            .range(1024, 256 << 20)
            .group(limitGroup)
            .byDefault(256 << 10));
    addSetting(
        Field::integer(QStringLiteral("limits.reply_bytes"),
                       QStringLiteral("Unsent replies of a new client; beyond it the client is closed"))
            .unit(QStringLiteral("B"))
            .range(1024, 15 << 20)
            .group(limitGroup)
            .byDefault(2 << 20));
    addSetting(Field::integer(QStringLiteral("limits.clients"), QStringLiteral("Clients at the same time"))
                   .range(1, 1000)
                   .group(limitGroup)
                   .byDefault(16));
    addSetting(Field::integer(QStringLiteral("limits.batch"), QStringLiteral("Requests in one batch"))
                   .range(1, 100000)
                   .group(limitGroup)
                   .byDefault(1000));
    addSetting(
        Field::integer(QStringLiteral("limits.pending"),
                       QStringLiteral("Unanswered requests of a new client; beyond it further ones wait"))
            .range(1, 10000)
            .group(limitGroup)
            .byDefault(32));
    addSetting(Field::number(QStringLiteral("limits.idle_s"),
                             QStringLiteral(
                                 "A new client without subscriptions is closed after this silence; 0: never"))
                   .unit(QStringLiteral("s"))
                   .range(0, 1e6)
                   .group(limitGroup)
                   .byDefault(900));
    addSetting(Field::text(QStringLiteral("log.level"), QStringLiteral("Least level that is written"))
                   .choices(levels)
                   .group(logGroup)
                   .byDefault(QStringLiteral("info")));
    addSetting(
        Field::integer(QStringLiteral("log.records"), QStringLiteral("Records kept in memory for log.tail"))
            .range(1, 100000)
            .group(logGroup)
            .byDefault(1000));
}

void Daemon::applyCommonSettings() {
    SessionLimits limits;
    limits.frameBytes = configuration_.integer(QStringLiteral("limits.frame_bytes"));
    limits.topicBytes = configuration_.integer(QStringLiteral("limits.topic_bytes"));
    limits.replyBytes = configuration_.integer(QStringLiteral("limits.reply_bytes"));
    limits.batch = configuration_.integer(QStringLiteral("limits.batch"));
    limits.pending = configuration_.integer(QStringLiteral("limits.pending"));
    limits.idle_s = configuration_.number(QStringLiteral("limits.idle_s"));
    channels_.setLimits(limits, configuration_.integer(QStringLiteral("limits.clients")));
    channels_.setAccess(
        {roleFrom(configuration_.text(QStringLiteral("access.plain"))).value_or(Role::Observer),
         roleFrom(configuration_.text(QStringLiteral("access.others"))).value_or(Role::Observer)});
    Log::instance().setMinimumLevel(
        LogLevel(levels.indexOf(configuration_.text(QStringLiteral("log.level")))));
    Log::instance().setCapacity(configuration_.integer(QStringLiteral("log.records")));
}

void Daemon::openAudit() {
    const QString folder = configuration_.text(QStringLiteral("audit.folder"));
    channels_.audit().open(!configuration_.flag(QStringLiteral("audit.on")) ? QString()
                           : folder.isEmpty()                               ? Audit::usualFolder()
                                                                            : folder,
                           self_.name, configuration_.integer(QStringLiteral("audit.file_bytes")),
                           configuration_.integer(QStringLiteral("audit.files")));
    healthItems_.provide(QStringLiteral("audit"), [this] {
        const auto state = channels_.audit().state();
        if (!state)
            return healthItems_.set(QStringLiteral("audit"), HealthLevel::Ok, QStringLiteral("off"));
        const QJsonObject values{{QStringLiteral("written"), double(state->written)},
                                 {QStringLiteral("lost"), double(state->lost)}};
        if (channels_.audit().isFlooded())
            return healthItems_.set(
                QStringLiteral("audit"), HealthLevel::Warn,
                QStringLiteral("so many commands come that they are summed up: a line a minute for each "
                               "client and command, without parameters"),
                values);
        constexpr double told_s = 60;
        if (monotonicNow() - state->lostAt > told_s)
            return healthItems_.set(QStringLiteral("audit"), HealthLevel::Ok, channels_.audit().path(),
                                    values);
        healthItems_.set(QStringLiteral("audit"), HealthLevel::Warn,
                         QStringLiteral("the audit of commands cannot be written: ") + state->problem,
                         values);
    });
}

} // namespace hermes
