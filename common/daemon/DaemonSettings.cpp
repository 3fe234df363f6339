#include "common/Log.h"
#include "common/daemon/Daemon.h"
#include "common/interface/InterfaceRegistry.h"
#include "common/settings/SettingsTable.h"
#include "protocol/jsonrpc/Codec.h"

namespace hermes {
namespace {

const QStringList levels{QStringLiteral("debug"), QStringLiteral("info"), QStringLiteral("warning"),
                         QStringLiteral("error")};

// What is wrong with an address to listen at; nothing: empty.
QString wrongListen(const QString &text, bool fromNetwork) {
    const auto url = InterfaceUrl::parse(text);
    if (!url)
        return "a URL like tcp://127.0.0.1:7410?protocol=json";
    if (!interfaceSchemes().contains(url->scheme))
        return "one of the schemes " + interfaceSchemes().join(", ");
    if (!codecNames().contains(url->protocol()))
        return "one of the protocols " + codecNames().join(", ");
    if (isOpenToNetwork(*url) && !fromNetwork)
        return "an address that only this computer reaches, as 127.0.0.1: in plain text others on "
               "the network could command this daemon; \"insecure\": true accepts that "
               "(--set insecure=true)";
    return {};
}

// With addresses that cannot work the daemon would not start again.
std::vector<SchemaViolation> checkListen(const QJsonObject &settings, bool fromNetwork) {
    const QJsonArray listen = settings.value("listen").toArray();
    std::vector<SchemaViolation> wrong;
    for (int i = 0; i < listen.size(); ++i) {
        const QString expected = wrongListen(listen.at(i).toString(), fromNetwork);
        if (!expected.isEmpty())
            wrong.push_back({QString("listen.%1").arg(i), listen.at(i), expected});
    }
    return wrong;
}

// The settings that every daemon has, but for where it listens.
struct CommonSettings : SettingsTable {
    bool insecure = false, audits = true;
    QString plainRole = toString(Role::Operator), otherRole = toString(Role::Observer);
    QString auditFolder, logLevel = "info";
    int auditBytes = 1 << 20, auditFiles = 5, clients = 16, logRecords = 1000;
    SessionLimits limits;

    CommonSettings();
    explicit CommonSettings(const Settings &settings)
        : CommonSettings() {
        read(settings.inForce());
    }
};

CommonSettings::CommonSettings() {
    group("Channels");
    add("insecure", insecure, "Accept commands in plain text from the network, not only from this host")
        .appliesOnRestart();
    add("access.plain", plainRole,
        "Role of clients without a certificate: programs of the daemon's own user "
        "over TCP, lines, UDP, and the network where insecure is true")
        .choices(roleNames());
    add("access.others", otherRole, "Role of programs of other users of this computer").choices(roleNames());
    group("Log");
    add("log.level", logLevel, "Least level that is written").choices(levels);
    add("log.records", logRecords, "Records kept in memory for log.tail").range(1, 100000);
    group("Log", Applies::OnRestart);
    add("audit.on", audits,
        "Write an audit of who commands what: a line of JSON for each command that changes something");
    add("audit.folder", auditFolder,
        "Folder of the audit; empty: audit in the state folder of the service or of the user");
    add("audit.file_bytes", auditBytes, "Size of an audit file; then a new one begins", "B", 4096, 1 << 30);
    add("audit.files", auditFiles, "Audit files that are kept").range(1, 1000);
    group("Limits");
    add("limits.frame_bytes", limits.frameBytes, "Largest request of a new client", "B", 1024, 64 << 20);
    add("limits.topic_bytes", limits.topicBytes,
        "Unsent topic data of a new client; beyond it the oldest is dropped", "B", 1024, 256 << 20);
    add("limits.reply_bytes", limits.replyBytes,
        "Unsent replies of a new client; beyond it the client is closed", "B", 1024, 15 << 20);
    add("limits.clients", clients, "Clients at the same time").range(1, 1000);
    add("limits.batch", limits.batch, "Requests in one batch").range(1, 100000);
    add("limits.pending", limits.pending, "Unanswered requests of a new client; beyond it further ones wait")
        .range(1, 10000);
    add("limits.idle_s", limits.idle_s,
        "A new client without subscriptions is closed after this silence; 0: never", "s", 0, 1e6);
}

} // namespace

void Daemon::declareCommonSettings() {
    const QString address = QString("tcp://127.0.0.1:%1?protocol=json").arg(self_.port);
    addSetting(Field::array("listen", "URLs at which commands are accepted", {{"type", "string"}})
                   .with("minItems", 1)
                   .group("Channels")
                   .byDefault(QJsonArray{address})
                   .appliesOnRestart());
    configuration_.addRule([this](const QJsonObject &settings) {
        // At the start launch() says it, when all settings are known.
        return checkListen(settings, !launched_ || settings.value("insecure").toBool());
    });
    CommonSettings().declareIn(configuration_);
}

void Daemon::applyCommonSettings() {
    const CommonSettings common(configuration_);
    channels_.setLimits(common.limits, common.clients);
    channels_.setAccess({roleFrom(common.plainRole).value_or(Role::Observer),
                         roleFrom(common.otherRole).value_or(Role::Observer)});
    Log::instance().setMinimumLevel(LogLevel(levels.indexOf(common.logLevel)));
    Log::instance().setCapacity(common.logRecords);
}

void Daemon::openAudit() {
    const CommonSettings common(configuration_);
    channels_.audit().open(!common.audits                 ? QString()
                           : common.auditFolder.isEmpty() ? Audit::usualFolder()
                                                          : common.auditFolder,
                           self_.name, common.auditBytes, common.auditFiles);
    healthItems_.provide("audit", [this] {
        const auto state = channels_.audit().state();
        if (!state)
            return healthItems_.set("audit", HealthLevel::Ok, "off");
        const QJsonObject values{{"written", double(state->written)}, {"lost", double(state->lost)}};
        if (channels_.audit().isFlooded())
            return healthItems_.set("audit", HealthLevel::Warn,
                                    "so many commands come that they are summed up: a line a minute for each "
                                    "client and command, without parameters",
                                    values);
        constexpr double told_s = 60;
        if (monotonicNow() - state->lostAt > told_s)
            return healthItems_.set("audit", HealthLevel::Ok, channels_.audit().path(), values);
        healthItems_.set("audit", HealthLevel::Warn,
                         "the audit of commands cannot be written: " + state->problem, values);
    });
}

} // namespace hermes
