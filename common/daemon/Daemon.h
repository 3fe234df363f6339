#pragma once

#include "common/Time.h"
#include "common/daemon/Command.h"
#include "common/daemon/CommandLine.h"
#include "common/daemon/CommandRegistry.h"
#include "common/daemon/Health.h"
#include "common/daemon/Server.h"
#include "common/daemon/Topic.h"
#include "common/daemon/TopicHub.h"
#include "common/network/Announcement.h"
#include "common/settings/Settings.h"

#include <QCoreApplication>
#include <QObject>
#include <QTimer>
#include <memory>

namespace hermes {

/// Who a daemon is.
struct DaemonIdentity {
    QString name;        ///< as in the program hermes-NAME, e.g. "velodynelogger"
    QString title;       ///< for people, e.g. "Velodyne logger"
    QString description; ///< one or two sentences
    quint16 port = 0;    ///< default port on 127.0.0.1; 0: that of defaultPort(name), else any free one
};

enum class DaemonState { Starting, Ready, Running, Degraded, Fault, Stopping };

QString toString(DaemonState state);

/// The skeleton of every daemon: command line, settings, command channels, common commands, topics, health,
/// log, signals, service manager, orderly shutdown. A daemon derives from it, declares its commands, topics
/// and settings in the constructor, and does its work between start() and stop(). docs/add-a-daemon.md has an
/// example. Use everything here from the main thread; other threads post to it with
/// QMetaObject::invokeMethod.
class Daemon : public QObject {
    Q_OBJECT
public:
    explicit Daemon(const DaemonIdentity &identity);
    ~Daemon() override;

    /// Command line, start, event loop, stop. arguments begin with the program's name. Gives the exit status:
    /// 0, 2 for a usage error, 1 for any other failure.
    int run(const QStringList &arguments);

    /// The parts of run(), for tests in one process. prepare() reads the command line: an exit status when
    /// there is nothing to run. launch() listens and starts. shutDown() ends in order, then emits finished().
    std::optional<int> prepare(const QStringList &arguments);
    Result<void> launch();
    void shutDown(int status = 0);

    const DaemonIdentity &identity() const { return self_; }
    Settings &settings() { return configuration_; }
    Health &health() { return healthItems_; }
    Server &server() { return channels_; }

    /// Degraded when ready or running and a health item is at error or stale.
    DaemonState state() const;
    /// The OpenRPC document that rpc.discover gives.
    QJsonObject description() const;
    /// Changes when anything in the description changes.
    QString descriptionHash() const;
    /// As told to a client of that role.
    DaemonInfo info(Role asking = Role::Engineer) const;
    DaemonStatus status();

    bool hasSubscribers(const QString &topic) const { return topics_.hasSubscribers(topic); }
    /// False while a subscriber with a queue longer than one is behind: for data that can wait.
    bool hasRoom(const QString &topic) const { return topics_.hasRoom(topic); }

Q_SIGNALS:
    /// A client has gone; Call::client told who it was.
    void clientGone(quint64 client);
    /// Everything has ended in order; status is for the program to exit with.
    void finished(int status);

protected:
    // For the constructor of a daemon.
    void addSetting(const Field &field) {
        configuration_.declare(field);
        forgetDescription();
    }
    void addCommand(const Command &command) {
        commands_.add(command);
        forgetDescription();
    }
    void addCommands(const std::vector<Command> &commands) {
        for (const Command &command : commands)
            addCommand(command);
    }
    void addTopic(const Topic &topic) {
        topics_.declare(topic);
        forgetDescription();
    }
    /// The watchdog of the service manager is fed by feedWatchdog() alone, not by the event loop.
    void feedWatchdogMyself() { watchdogByHand_ = true; }
    /// Of who starts the others: as a service it runs with its defaults where the settings file is wrong, and
    /// its health tells what is wrong; a service that has ended tells nobody. Once the file is mended it ends
    /// in order, and the service manager starts it anew.
    void runWithWrongFile() { runsWithWrongFile_ = true; }

    // For its work.
    /// To all subscribers; stamp is when the data were true (seconds since the epoch). The data may be a
    /// function that gives them: it is not called without subscribers.
    template <typename Data>
    void publish(const QString &topic, const Data &data, double stamp = stampNow()) {
        if constexpr (std::is_invocable_v<const Data &>)
            topics_.publish(topic, data, stamp);
        else
            topics_.publish(
                topic, [&data] { return Outgoing(data); }, stamp);
    }
    /// The full state of a topic with a snapshot in parts once more, to all subscribers.
    void publishSnapshot(const QString &topic) { topics_.publishSnapshot(topic); }
    /// Ready: can work. Running: works. Fault: cannot, with a health item that says why.
    void setState(DaemonState state);
    void feedWatchdog();

    // What a daemon may override.
    /// Begins the work; settings are valid, channels are open. An error ends the program with status 1.
    virtual Result<void> start() { return {}; }
    /// Ends the work: files closed, motors stopped. Called once, also after a start() that failed.
    virtual void stop() {}
    /// Settings were changed while running; paths are dotted.
    virtual void settingsChanged(const QStringList &paths) { Q_UNUSED(paths) }

private:
    void declareCommonSettings();
    void applyCommonSettings();
    void openAudit();
    void waitForMended(const QString &file);
    Result<void> listen(const QString &url);
    void listenLater();
    void updateChannelHealth();
    void publishStatus();
    /// Each change of the level or the reason; numbers in it change all the time.
    void logHealth(const HealthItem &item);
    Result<void> configure(const CommandLine &line);
    QString helpText() const;
    void forgetDescription();

    DaemonIdentity self_;
    Settings configuration_;
    CommandRegistry commands_;
    TopicHub topics_;
    Health healthItems_;
    Server channels_;
    DaemonState ownState_ = DaemonState::Starting;
    double started_ = 0; // stamp
    double startedMono_ = 0;
    mutable QJsonObject made_; // the description, when it was asked for
    mutable QString madeHash_;
    bool launched_ = false;
    bool watchdogByHand_ = false;
    bool runsWithWrongFile_ = false;
    QTimer watchdog_, mended_, listenAgain_;
    QMap<QString, QString> unheard_;       // addresses that cannot be listened at yet, and why
    std::vector<AnnouncedPort> reachable_; // by others on the network
    QString toldState_;
    QMap<QString, QString> toldLevels_, loggedReasons_; // of the health items
    QTimer statusTimer_;
    std::unique_ptr<Announcement> announcement_; // while others on the network can reach it
};

/// The whole main() of a daemon.
template <typename T>
int runDaemon(int argc, char **argv) {
    QCoreApplication application(argc, argv);
    const int status = T().run(application.arguments());
    Announcement::endProgramIfHeld(status);
    return status;
}

} // namespace hermes
