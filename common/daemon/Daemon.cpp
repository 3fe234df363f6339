#include "common/daemon/Daemon.h"

#include "common/Log.h"
#include "common/Project.h"
#include "common/Time.h"
#include "common/daemon/CommonCommands.h"
#include "common/daemon/SignalWatcher.h"
#include "common/daemon/Systemd.h"
#include "common/schema/SchemaText.h"
#include "common/settings/DottedPath.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"

#include <QCryptographicHash>
#include <QJsonDocument>
#include <QSysInfo>
#include <algorithm>
#include <cstdio>

namespace hermes {
namespace {

void print(FILE *stream, const QString &text) {
    std::fputs(text.toUtf8().constData(), stream);
}

/// The exit status of a program that had nothing to do but to print this.
int printed(const QString &text) {
    print(stdout, text);
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
        return 0;
    print(stderr, QStringLiteral("stdout cannot be written: %1\n").arg(qt_error_string()));
    return 1;
}

} // namespace

QString toString(DaemonState state) {
    static const char *const names[] = {"starting", "ready", "running", "degraded", "fault", "stopping"};
    return QLatin1String(names[int(state)]);
}

Daemon::Daemon(const DaemonIdentity &identity)
    : self(identity)
    , topics(this)
    , healthItems(this)
    , channels(commands, topics, this)
    , started(stampNow())
    , startedMono(monotonicNow()) {
    if (self.port == 0)
        self.port = defaultPort(self.name);
    declareCommonSettings();
    addCommonCommands(*this, commands, topics);
    connect(&channels, &Server::clientGone, this, &Daemon::clientGone);
    Log::instance().follow(this, [this](const LogRecord &record) {
        publish(
            QStringLiteral("log"), [&record] { return record.message(); }, record.stamp);
    });
    connect(&configuration, &Settings::changed, this, [this](const QStringList &paths) {
        if (!launched)
            return;
        applyCommonSettings();
        settingsChanged(paths);
        publish(QStringLiteral("settings"), [this] { return configuration.values(); });
    });
    healthItems.provide(QStringLiteral("channel"), [this] { updateChannelHealth(); });
}

Daemon::~Daemon() {
    Log::instance().unfollow(this);
}

int Daemon::run(const QStringList &arguments) {
    Log::instance().captureQtMessages();
    if (const auto status = prepare(arguments))
        return *status;
    SignalWatcher signalWatcher(this);
    connect(&signalWatcher, &SignalWatcher::received, this, [this](const QString &name) {
        logInfo(self.name, name + QStringLiteral(" received"));
        shutDown();
    });
    connect(this, &Daemon::finished, this, [](int status) { QCoreApplication::exit(status); });
    const auto launching = launch();
    if (!launching) {
        print(stderr, QStringLiteral("hermes-%1: %2\n").arg(self.name, launching.error().message));
        return 1;
    }
    return QCoreApplication::exec();
}

std::optional<int> Daemon::prepare(const QStringList &arguments) {
    const QString program = QStringLiteral("hermes-") + self.name;
    const auto line = CommandLine::parse(arguments.mid(1));
    if (!line) {
        print(stderr,
              QStringLiteral("%1: %2\n%1 --help tells what there is\n").arg(program, line.error().message));
        return 2;
    }
    if (line->action == CommandLine::Action::Help) {
        return printed(helpText());
    }
    if (line->action == CommandLine::Action::Version) {
        return printed(QStringLiteral("%1 %2\n").arg(program, projectVersion()));
    }
    const auto configured = configure(*line);
    if (!configured) {
        print(stderr, QStringLiteral("%1: %2\n").arg(program, configured.error().message));
        return configured.error().is(ErrorCode::InvalidParams) ? 2 : 1;
    }
    if (line->action == CommandLine::Action::PrintSettings) {
        return printed(QString::fromUtf8(QJsonDocument(configuration.values()).toJson()));
    }
    if (line->action == CommandLine::Action::Check) {
        return printed(QStringLiteral("%1: the settings are valid\n").arg(program));
    }
    return std::nullopt;
}

Result<void> Daemon::configure(const CommandLine &line) {
    if (!line.config.isEmpty()) {
        const auto loaded = configuration.load(line.config);
        if (!loaded)
            return loaded;
    }
    const auto set = configuration.set(line.settings);
    if (!set)
        return Error(ErrorCode::InvalidParams, QStringLiteral("option --set: ") + set.error().message);
    if (!line.listen.isEmpty()) {
        const auto listen =
            configuration.set({{QStringLiteral("listen"), QJsonArray::fromStringList(line.listen)}});
        if (!listen)
            return Error(ErrorCode::InvalidParams,
                         QStringLiteral("option --listen: ") + listen.error().message);
    }
    applyCommonSettings();
    return {};
}

Result<void> Daemon::launch() {
    const bool insecure = configuration.flag(QStringLiteral("insecure"));
    for (const QJsonValue &url : configuration.value(QStringLiteral("listen")).toArray()) {
        const auto listening = channels.listen(url.toString(), insecure);
        if (!listening) {
            channels.close();
            return listening;
        }
    }
    if (insecure) {
        healthItems.set(
            QStringLiteral("insecure"), HealthLevel::Warn,
            QStringLiteral("commands are accepted in plain text, from the network if a channel listens "
                           "there (setting \"insecure\")"));
    }
    launched = true;
    startedWith = configuration.values();
    const auto starting = start();
    if (!starting) {
        logError(self.name, starting.error().message);
        stop();
        channels.close();
        return starting;
    }
    if (ownState == DaemonState::Starting)
        setState(DaemonState::Ready);
    connect(&healthItems, &Health::changed, this, &Daemon::publishStatus);
    connect(&statusTimer, &QTimer::timeout, this, &Daemon::publishStatus); // an item may have become stale
    statusTimer.start(500);
    systemd::notify("READY=1");
    const auto interval = systemd::watchdogInterval();
    if (interval.count() > 0 && !watchdogByHand) {
        connect(&watchdog, &QTimer::timeout, this, &Daemon::feedWatchdog);
        watchdog.start(interval);
    }
    return {};
}

void Daemon::shutDown(int status) {
    if (ownState == DaemonState::Stopping)
        return;
    setState(DaemonState::Stopping);
    systemd::notify("STOPPING=1");
    statusTimer.stop();
    stop();
    logInfo(self.name, QStringLiteral("stopped"));
    channels.close();
    Q_EMIT finished(status);
}

DaemonState Daemon::state() const {
    const bool working = ownState == DaemonState::Ready || ownState == DaemonState::Running;
    return working && healthItems.worst() >= HealthLevel::Failed ? DaemonState::Degraded : ownState;
}

void Daemon::setState(DaemonState state) {
    if (state == ownState || ownState == DaemonState::Stopping)
        return; // news that came too late
    ownState = state;
    logInfo(self.name, toString(state));
    publishStatus();
}

void Daemon::feedWatchdog() {
    systemd::notify("WATCHDOG=1");
}

QJsonObject Daemon::description() const {
    if (!made.isEmpty())
        return made;
    made = {{QStringLiteral("openrpc"), QStringLiteral("1.2.6")},
            {QStringLiteral("info"), QJsonObject{{QStringLiteral("title"), self.title},
                                                 {QStringLiteral("version"), projectVersion()},
                                                 {QStringLiteral("description"), self.description}}},
            {QStringLiteral("methods"), commands.description()},
            {QStringLiteral("x-topics"), asJson(topics.description())}};
    return made;
}

void Daemon::forgetDescription() {
    made = {};
    madeHash.clear();
}

QString Daemon::descriptionHash() const {
    if (madeHash.isEmpty()) {
        const QByteArray all = compactJson(description()) + compactJson(configuration.schema());
        madeHash =
            QString::fromLatin1(QCryptographicHash::hash(all, QCryptographicHash::Sha256).toHex().left(16));
    }
    return madeHash;
}

DaemonInfo Daemon::info() const {
    return {self.name,
            self.title,
            projectVersion(),
            protocolVersion(),
            descriptionHash(),
            QSysInfo::machineHostName(),
            QCoreApplication::applicationPid(),
            channels.addresses(),
            started,
            monotonicNow() - startedMono};
}

DaemonStatus Daemon::status() {
    std::vector<HealthItem> items = healthItems.list(); // before the state, which follows from them
    return {toString(state()), std::move(items),
            configuration.needRestart(leafPaths(difference(configuration.values(), startedWith)))};
}

void Daemon::publishStatus() {
    // Only a change of a level or of the state is news; ages and counters change all the time.
    QString now = toString(state());
    for (const HealthItem &item : healthItems.list())
        now += QLatin1Char(' ') + item.name + QLatin1Char('=') + item.level;
    if (now == lastStatus)
        return;
    lastStatus = now;
    publish(QStringLiteral("status"), [this] { return status(); });
}

void Daemon::updateChannelHealth() {
    const QJsonObject counters = channels.counters();
    const double dropped = counters.value(QStringLiteral("dropped_topic_messages")).toDouble();
    const QString message = QStringLiteral("%1 clients, %2 topic messages dropped for slow readers")
                                .arg(counters.value(QStringLiteral("clients")).toInt())
                                .arg(dropped);
    healthItems.set(QStringLiteral("channel"), HealthLevel::Ok, message, counters);
}

QString Daemon::helpText() const {
    QString text = QStringLiteral("Usage: hermes-%1 [OPTION]...\n\n%2. %3\n\n")
                       .arg(self.name, self.title, self.description);
    text += CommandLine::help() + QStringLiteral("\nSettings (PATH = default: meaning):\n");
    for (const QString &path : leafPaths(configuration.defaults())) {
        QJsonObject schema = configuration.schema();
        for (const QString &key : path.split(QLatin1Char('.')))
            schema = schema.value(QStringLiteral("properties")).toObject().value(key).toObject();
        text += QStringLiteral("  %1 = %2: %3 (%4)\n")
                    .arg(path, shown(schema.value(QStringLiteral("default"))),
                         schema.value(QStringLiteral("description")).toString(), expectation(schema));
    }
    return text;
}

} // namespace hermes
