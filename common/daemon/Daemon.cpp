#include "common/daemon/Daemon.h"

#include "common/Log.h"
#include "common/OwnRobot.h"
#include "common/Project.h"
#include "common/Time.h"
#include "common/daemon/CommonCommands.h"
#include "common/daemon/SignalWatcher.h"
#include "common/daemon/Systemd.h"
#include "common/help/HelpText.h"
#include "common/schema/Angles.h"
#include "common/schema/SchemaText.h"
#include "common/settings/DottedPath.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"

#include <QCryptographicHash>
#include <QJsonDocument>
#include <QRegularExpression>
#include <QSysInfo>
#include <algorithm>
#include <cstdio>
#include <utility>

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
    print(stderr, QString("stdout cannot be written: %1\n").arg(qt_error_string()));
    return 1;
}

} // namespace

QString toString(DaemonState state) {
    static const char *const names[] = {"starting", "ready", "running", "degraded", "fault", "stopping"};
    return QLatin1String(names[int(state)]);
}

Daemon::Daemon(const DaemonIdentity &identity)
    : self_(identity)
    , topics_(this)
    , healthItems_(this)
    , channels_(commands_, topics_, this)
    , started_(stampNow())
    , startedMono_(monotonicNow()) {
    if (self_.port == 0)
        self_.port = defaultPort(self_.name);
    declareCommonSettings();
    addCommonCommands(*this, commands_, topics_);
    connect(&channels_, &Server::clientGone, this, &Daemon::clientGone);
    connect(&channels_.audit(), &Audit::noted, this,
            [this](const CommandMessage &entry) { publish("commands", entry, entry.stamp); });
    connect(&topics_, &TopicHub::replaysChanged, this, [this] {
        const QString item = "topics", replays = topics_.replays();
        if (replays.isEmpty())
            healthItems_.remove(item);
        else
            healthItems_.set(item, HealthLevel::Warn, "replayed, not live: " + replays);
    });
    Log::instance().follow(this, [this](const LogRecord &record) {
        publish(
            "log", [&record] { return record.message(); }, record.stamp);
    });
    connect(&configuration_, &Settings::changed, this, [this](const QStringList &paths) {
        QJsonObject changes;
        for (const QString &path : paths)
            changes = withValueAt(changes, path, valueAt(configuration_.values(), path));
        for (const QString &text : beyondTurn(configuration_.schema(), changes))
            logWarning("settings", text);
        if (!launched_)
            return;
        applyCommonSettings();
        settingsChanged(paths);
        publish("settings", [this] { return configuration_.values(); });
    });
    healthItems_.provide("channel", [this] { updateChannelHealth(); });
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
        logInfo(self_.name, name + " received");
        shutDown();
    });
    connect(this, &Daemon::finished, this, [](int status) { QCoreApplication::exit(status); });
    const auto launching = launch();
    if (!launching) {
        print(stderr, QString("hermes-%1: %2\n").arg(self_.name, launching.error().message));
        return 1;
    }
    return QCoreApplication::exec();
}

std::optional<int> Daemon::prepare(const QStringList &arguments) {
    const QString program = "hermes-" + self_.name;
    const auto line = CommandLine::parse(arguments.mid(1));
    if (!line) {
        print(stderr, QString("%1: %2; %1 --help tells what there is\n").arg(program, line.error().message));
        return 2;
    }
    if (line->action == CommandLine::Action::Help) {
        return printed(QString::fromStdString(fittedHelp(helpText().toStdString())));
    }
    if (line->action == CommandLine::Action::Version) {
        return printed(QString("%1 %2\n").arg(program, projectVersion()));
    }
    const auto configured = configure(*line);
    if (!configured) {
        print(stderr, QString("%1: %2\n").arg(program, configured.error().message));
        return configured.error().is(ErrorCode::InvalidParams) ? 2 : 1;
    }
    if (line->action == CommandLine::Action::PrintSettings) {
        return printed(QString::fromUtf8(QJsonDocument(configuration_.values()).toJson()));
    }
    if (line->action == CommandLine::Action::Check) {
        return printed(QString("%1: the settings are valid\n").arg(program));
    }
    return std::nullopt;
}

Result<void> Daemon::configure(const CommandLine &line) {
    if (!line.config.isEmpty()) {
        const auto loaded = configuration_.load(line.config);
        const bool goesOn =
            runsWithWrongFile_ && line.action == CommandLine::Action::Run && systemd::isService();
        if (!loaded && !goesOn)
            return loaded;
        if (!loaded) {
            logError(self_.name, loaded.error().message);
            healthItems_.set("settings file", HealthLevel::Failed,
                             loaded.error().message + "; the service restarts when the file is correct");
            waitForMended(line.config);
        }
    }
    const auto set = configuration_.insist(line.settings);
    // What only a rule refuses may suit the file once that is mended: it is no wrong command line.
    if (!set && !line.config.isEmpty() && configuration_.suitsSchema(line.settings))
        return Error(ErrorCode::InvalidSetting,
                     QString("settings file %1 with option --set: %2").arg(line.config, set.error().message));
    if (!set)
        return Error(ErrorCode::InvalidParams, "option --set: " + set.error().message);
    if (!line.listen.isEmpty()) {
        const auto listen = configuration_.insist({{"listen", QJsonArray::fromStringList(line.listen)}});
        if (!listen)
            return Error(ErrorCode::InvalidParams, "option --listen: " + listen.error().message);
    }
    applyCommonSettings();
    return {};
}

void Daemon::waitForMended(const QString &file) {
    connect(&mended_, &QTimer::timeout, this, [this, file] {
        if (!configuration_.read(file))
            return;
        logInfo(self_.name, QString("settings file %1: it is correct now").arg(file));
        shutDown();
    });
    mended_.start(std::chrono::seconds(1));
}

Result<void> Daemon::launch() {
    const bool insecure = configuration_.flag("insecure");
    openAudit();
    if (qEnvironmentVariableIsSet(robotVariable) && !ownRobot())
        logWarning(self_.name, QString("%1 is ignored: expected the UUID of a robot, a space and its "
                                       "name of up to %2 printable characters")
                                   .arg(QLatin1String(robotVariable))
                                   .arg(longestRobotName));
    Result<void> failed;
    for (const QJsonValue &url : configuration_.value("listen").toArray()) {
        const auto listening = listen(url.toString());
        failed = listening ? failed : listening;
        if (!listening && listening.error().is(ErrorCode::InputOutput))
            unheard_.insert(url.toString(), listening.error().message);
        else if (!listening) // it will not be otherwise later
            return channels_.close(), listening;
    }
    // Whoever started it by hand waits for a word; a service is not to be given up.
    if (!failed && channels_.addresses().isEmpty() && !systemd::isService())
        return channels_.close(), failed;
    listenLater();
    if (insecure) {
        healthItems_.set("insecure", HealthLevel::Warn,
                         "commands are accepted in plain text, from the network if a channel listens "
                         "there (setting \"insecure\")");
    }
    launched_ = true;
    configuration_.begin();
    const auto starting = start();
    if (!starting) {
        logError(self_.name, starting.error().message);
        stop();
        channels_.close();
        return starting;
    }
    if (ownState_ == DaemonState::Starting)
        setState(DaemonState::Ready);
    connect(&healthItems_, &Health::changed, this, &Daemon::publishStatus);
    connect(&statusTimer_, &QTimer::timeout, this, &Daemon::publishStatus); // an item may have become stale
    statusTimer_.start(500);
    if (!reachable_.empty())
        announcement_ = std::make_unique<Announcement>(self_.name, reachable_);
    systemd::notify("READY=1");
    const auto interval = systemd::watchdogInterval();
    if (interval.count() > 0 && !watchdogByHand_) {
        connect(&watchdog_, &QTimer::timeout, this, &Daemon::feedWatchdog);
        watchdog_.start(interval);
    }
    return {};
}

Result<void> Daemon::listen(const QString &url) {
    const auto listening = channels_.listen(url, configuration_.flag("insecure"));
    if (!listening)
        return listening;
    if (const auto port = AnnouncedPort::of(self_.name, url, channels_.addresses().last()))
        reachable_.push_back(*port);
    return {};
}

/// An address that comes up late, a port that somebody still has, keys that are not valid before the clock is
/// set.
void Daemon::listenLater() {
    if (unheard_.isEmpty())
        return;
    for (const QString &why : qAsConst(unheard_))
        logError(self_.name, why + "; it is tried again each second");
    connect(&listenAgain_, &QTimer::timeout, this, [this] {
        const auto before = reachable_.size();
        for (const QString &url : unheard_.keys()) {
            const auto listening = listen(url);
            if (listening)
                unheard_.remove(url);
            else
                unheard_[url] = listening.error().message;
        }
        if (unheard_.isEmpty())
            listenAgain_.stop();
        if (reachable_.size() > before) {
            announcement_.reset();
            announcement_ = std::make_unique<Announcement>(self_.name, reachable_);
        }
    });
    listenAgain_.start(std::chrono::seconds(1));
}

void Daemon::shutDown(int status) {
    if (ownState_ == DaemonState::Stopping)
        return;
    setState(DaemonState::Stopping);
    systemd::notify("STOPPING=1");
    statusTimer_.stop();
    listenAgain_.stop();
    stop();
    announcement_.reset();
    logInfo(self_.name, "stopped");
    channels_.close();
    Q_EMIT finished(status);
}

DaemonState Daemon::state() const {
    const bool working = ownState_ == DaemonState::Ready || ownState_ == DaemonState::Running;
    return working && healthItems_.worst() >= HealthLevel::Failed ? DaemonState::Degraded : ownState_;
}

void Daemon::setState(DaemonState state) {
    if (state == ownState_ || ownState_ == DaemonState::Stopping)
        return; // news that came too late
    ownState_ = state;
    logInfo(self_.name, toString(state));
    publishStatus();
}

void Daemon::feedWatchdog() {
    systemd::notify("WATCHDOG=1");
}

QJsonObject Daemon::description() const {
    if (!made_.isEmpty())
        return made_;
    made_ = {{"openrpc", "1.2.6"},
             {"info", QJsonObject{{"title", self_.title},
                                  {"version", projectVersion()},
                                  {"description", self_.description}}},
             {"methods", commands_.description()},
             {"x-topics", asJson(topics_.description())}};
    return made_;
}

void Daemon::forgetDescription() {
    made_ = {};
    madeHash_.clear();
}

QString Daemon::descriptionHash() const {
    if (madeHash_.isEmpty()) {
        const QByteArray all = compactJson(description()) + compactJson(configuration_.schema());
        madeHash_ =
            QString::fromLatin1(QCryptographicHash::hash(all, QCryptographicHash::Sha256).toHex().left(16));
    }
    return madeHash_;
}

DaemonInfo Daemon::info(Role asking) const {
    return {self_.name,
            self_.title,
            projectVersion(),
            protocolVersion(),
            descriptionHash(),
            QSysInfo::machineHostName(),
            QCoreApplication::applicationPid(),
            channels_.addresses(),
            started_,
            monotonicNow() - startedMono_,
            toString(asking),
            ownRobot()};
}

DaemonStatus Daemon::status() {
    std::vector<HealthItem> items = healthItems_.list(); // before the state, which follows from them
    return {toString(state()), std::move(items), configuration_.waiting()};
}

void Daemon::publishStatus() {
    // Only a change of a level or of the state is news; ages and counters change all the time.
    QMap<QString, QString> levels;
    for (const HealthItem &item : healthItems_.list()) {
        levels.insert(item.name, item.level);
        logHealth(item);
    }
    const QString now = toString(state());
    if (now == toldState_ && levels == toldLevels_)
        return;
    toldState_ = now;
    toldLevels_ = levels;
    publish("status", [this] { return status(); });
}

void Daemon::logHealth(const HealthItem &item) {
    static const QRegularExpression numbers("[0-9.]+");
    const bool isWell = item.level == toString(HealthLevel::Ok);
    const QString reason = isWell ? QString() : item.level + QString(item.message).remove(numbers);
    if (std::exchange(loggedReasons_[item.name], reason) == reason)
        return;
    const QString text = QString("%1 is %2: %3").arg(item.name, item.level, item.message);
    const bool isError = item.level == toString(HealthLevel::Failed);
    (isWell ? logInfo : isError ? logError : logWarning)("health", text);
}

void Daemon::updateChannelHealth() {
    const QJsonObject counters = channels_.counters();
    const double dropped = counters.value("dropped_topic_messages").toDouble();
    QString message = QString("%1 clients, %2 topic messages dropped for slow readers")
                          .arg(counters.value("clients").toInt())
                          .arg(dropped);
    const QStringList failures = channels_.failures() + unheard_.values();
    if (!failures.isEmpty())
        message = "no client is heard on: " + failures.join("; ");
    healthItems_.set("channel", failures.isEmpty() ? HealthLevel::Ok : HealthLevel::Failed, message,
                     counters);
}

QString Daemon::helpText() const {
    QString text =
        QString("Usage: hermes-%1 [OPTION]...\n\n%2. %3\n\n").arg(self_.name, self_.title, self_.description);
    text += CommandLine::help() + "\nSettings (PATH = default: meaning):\n";
    for (const QString &path : leafPaths(configuration_.defaults())) {
        QJsonObject schema = configuration_.schema();
        for (const QString &key : path.split(QLatin1Char('.')))
            schema = schema.value("properties").toObject().value(key).toObject();
        text += QString("  %1 = %2: %3 (%4)\n")
                    .arg(path, shown(schema.value("default")), schema.value("description").toString(),
                         expectation(schema));
    }
    return text;
}

} // namespace hermes
