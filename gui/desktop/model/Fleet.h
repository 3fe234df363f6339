#pragma once

#include "common/Result.h"
#include "gui/desktop/model/DaemonLink.h"
#include "protocol/messages/Processes.h"

#include <QPointer>
#include <memory>
#include <vector>

namespace hermes::desktop {

/// One robot: the daemons of one host. They are found through its supervisor, at their usual ports, or by
/// address.
class Robot : public QObject {
    Q_OBJECT
public:
    explicit Robot(const QString &host, QObject *parent = nullptr);

    const QString &host() const { return host_; }
    /// What the supervisor calls it, or the host.
    QString name() const;

    /// All daemons that have answered, were added by address or are named by the supervisor, in the order of
    /// their ports.
    std::vector<DaemonLink *> daemons() const;
    /// The first connected daemon that has the method or the topic; null: none.
    DaemonLink *withMethod(const QString &method) const;
    /// All connected daemons that have the method.
    std::vector<DaemonLink *> allWithMethod(const QString &method) const;
    DaemonLink *withTopic(const QString &topic) const;
    DaemonLink *withName(const QString &name) const;
    /// What the supervisor tells of a daemon; null: nothing.
    const ProcessStatus *process(const DaemonLink &daemon) const;
    DaemonLink *supervisor() const;
    /// What of the supervisor's list cannot be shown; empty: all is.
    const QString &problem() const { return problem_; }

    /// Looks for daemons at all usual ports.
    void search();
    /// A daemon at a port of this host; `isExpected`: show it although it does not answer yet.
    DaemonLink *add(quint16 port, bool isExpected);
    void remove(DaemonLink *daemon);

Q_SIGNALS:
    /// A daemon came or went, or its condition changed.
    void changed();
    /// A daemon can be looked up by what it can do: it was described, came back, or went.
    void capabilitiesChanged();

private:
    struct Entry {
        std::unique_ptr<DaemonLink> link;
        bool isExpected;
    };

    DaemonLink *found(quint16 port, bool isExpected);
    void followSupervisor(DaemonLink *link);
    void takeProcesses(WireView data);

    const QString host_;
    QString name_, problem_;
    std::map<quint16, Entry> entries_;
    std::vector<ProcessStatus> processes_;
    QPointer<DaemonLink> followed_;
};

/// All robots, and which robot and daemon the operator has chosen.
class Fleet : public QObject {
    Q_OBJECT
public:
    explicit Fleet(QObject *parent = nullptr);

    /// "HOST": every daemon found there; "HOST:PORT": that one, and all others when it is a supervisor.
    /// Error: it is no address.
    Result<void> add(const QString &address);
    /// All that were added.
    const QStringList &addresses() const { return addresses_; }
    const std::vector<std::unique_ptr<Robot>> &robots() const { return robots_; }

    Robot *robot() const { return robot_; }
    DaemonLink *daemon() const { return daemon_; }
    void choose(Robot *robot);
    void choose(DaemonLink *daemon);

Q_SIGNALS:
    /// Robots or daemons came or went, or the condition of one changed.
    void changed();
    void robotChosen(hermes::desktop::Robot *robot);
    void daemonChosen(hermes::desktop::DaemonLink *daemon);

private:
    Robot &robotAt(const QString &host);

    QStringList addresses_;
    QTimer changes_; // many that come together are told once
    std::vector<std::unique_ptr<Robot>> robots_;
    Robot *robot_ = nullptr;
    QPointer<DaemonLink> daemon_;
};

} // namespace hermes::desktop
