#pragma once

#include "gui/desktop/model/DaemonLink.h"
#include "protocol/messages/Daemons.h"

#include <QPointer>
#include <map>
#include <set>
#include <vector>

namespace hermes::desktop {

/// One robot: a supervisor with the daemons that it names, or, without one, the daemons of a host that no
/// supervisor names. Which daemons these are is the fleet's to say.
class Robot : public QObject {
    Q_OBJECT
public:
    static constexpr int longestName = 30;

    /// supervisor: null for the daemons that none names.
    Robot(const QString &host, const QString &address, DaemonLink *supervisor, QObject *parent = nullptr);
    ~Robot() override;

    const QString &host() const { return host_; }
    /// What tells it from all others: "HOST:PORT" of its supervisor, or "HOST", or "HOST#2" and so on for
    /// those that the operator has taken out of that.
    const QString &address() const { return address_; }
    /// What the operator calls it, else its supervisor, else its host.
    QString name() const;
    void setGivenName(const QString &name);

    /// All daemons of it that are to be shown, in the order of their ports.
    std::vector<DaemonLink *> daemons() const;
    bool has(const DaemonLink *daemon) const;
    /// The first connected daemon that has the method or the topic; null: none.
    DaemonLink *withMethod(const QString &method) const;
    /// All connected daemons that have the method.
    std::vector<DaemonLink *> allWithMethod(const QString &method) const;
    DaemonLink *withTopic(const QString &topic) const;
    DaemonLink *withName(const QString &name) const;
    /// What the supervisor tells of a daemon; null: nothing.
    const ProcessStatus *process(const DaemonLink &daemon) const;
    /// Null: it has none, or none that can be spoken to.
    DaemonLink *supervisor() const;
    /// It has one, away or not.
    bool isSupervised() const { return isSupervised_; }
    /// What of the supervisor's list cannot be shown, and what else is not as it should be; empty: nothing.
    QString problem() const;

    /// The ports that its supervisor names.
    const std::set<quint16> &named() const { return named_; }
    /// For the fleet; told to nobody.
    void take(DaemonLink *daemon);
    void release(DaemonLink *daemon);
    void setConflicts(const QStringList &conflicts);

Q_SIGNALS:
    /// A daemon came or went, or its condition changed.
    void changed();
    /// A daemon can be looked up by what it can do: it was described, came back, or went.
    void capabilitiesChanged();
    /// The supervisor names other ports than before, or itself otherwise.
    void namedChanged();

private:
    void takeProcesses(WireView data);
    void nameDaemons();

    const QString host_, address_;
    const bool isSupervised_;
    QPointer<DaemonLink> supervisor_;
    int handle_ = 0;
    QString givenName_, toldName_, problem_;
    QStringList conflicts_;
    std::map<quint16, DaemonLink *> daemons_;
    std::vector<ProcessStatus> processes_;
    std::set<quint16> named_;
};

} // namespace hermes::desktop
