#pragma once

#include "gui/desktop/model/DaemonLink.h"
#include "protocol/messages/Daemons.h"

#include <map>
#include <set>
#include <vector>

namespace hermes::desktop {

/// One robot: the daemons that say so by its id, on whatever hosts; or those of a host that know no robot.
/// Which these are is the fleet's to say.
class Robot : public QObject {
    Q_OBJECT
public:
    using Place = std::pair<QString, quint16>; ///< host and port
    static constexpr int longestName = 30;

    explicit Robot(const QString &id, QObject *parent = nullptr);

    /// What tells it from all others: its id, or the host.
    const QString &id() const { return id_; }
    /// Where its supervisors are, else its daemons.
    QString address() const;
    /// What the operator calls it, else it itself, else its id.
    QString name() const {
        return !givenName_.isEmpty() ? givenName_ : !toldName_.isEmpty() ? toldName_ : id_;
    }
    void setGivenName(const QString &name);

    /// All daemons of it that are to be shown, in the order of their ports.
    std::vector<DaemonLink *> daemons() const;
    bool has(const DaemonLink *daemon) const;
    /// The first connected daemon that has the method or the topic; null: none.
    DaemonLink *withMethod(const QString &method) const {
        return first(
            [&](const DaemonLink &daemon) { return daemon.isConnected() && daemon.hasMethod(method); });
    }
    /// All connected daemons that have the method.
    std::vector<DaemonLink *> allWithMethod(const QString &method) const;
    DaemonLink *withTopic(const QString &topic) const {
        return first(
            [&](const DaemonLink &daemon) { return daemon.isConnected() && daemon.hasTopic(topic); });
    }
    DaemonLink *withName(const QString &name) const {
        return first([&](const DaemonLink &daemon) { return daemon.isKnown() && daemon.name() == name; });
    }
    /// What a supervisor of its host tells of a daemon; null: nothing.
    const ProcessStatus *process(const DaemonLink &daemon) const { return find(daemon).second; }
    /// That supervisor; null: there is none, or none that can be spoken to.
    DaemonLink *supervisorOf(const DaemonLink &daemon) const;
    /// What of the supervisors' lists cannot be shown, and what else is not as it should be; empty: nothing.
    QString problem() const;

    /// Where its supervisors name daemons.
    const std::set<Place> &named() const { return named_; }
    /// For the fleet; told to nobody.
    void take(DaemonLink *daemon);
    void release(DaemonLink *daemon);
    void setConflicts(const QStringList &conflicts);

Q_SIGNALS:
    /// A daemon came or went, or its condition changed.
    void changed();
    /// A daemon can be looked up by what it can do: it was described, came back, or went.
    void capabilitiesChanged();
    /// The supervisors name others than before.
    void namedChanged();

private:
    struct Supervisor {
        Subscription subscription;
        std::vector<ProcessStatus> processes;
        QString problem;
    };
    using Found = std::pair<DaemonLink *, const ProcessStatus *>;

    template <typename IsWanted>
    DaemonLink *first(IsWanted isWanted) const {
        for (const auto &[place, daemon] : daemons_)
            if (isWanted(*daemon))
                return daemon;
        return nullptr;
    }
    void watch(DaemonLink *daemon);
    void takeProcesses(DaemonLink *supervisor, WireView data);
    void nameDaemons();
    bool findNamed();
    Found find(const DaemonLink &daemon) const;

    const QString id_;
    QString givenName_, toldName_;
    QStringList conflicts_;
    std::map<std::pair<quint16, QString>, DaemonLink *> daemons_;
    std::map<DaemonLink *, Supervisor> supervisors_;
    std::set<Place> named_;
};

} // namespace hermes::desktop
