#pragma once

#include "common/Result.h"
#include "gui/desktop/model/Robot.h"

#include <QHash>
#include <QMap>
#include <memory>

namespace hermes::desktop {

/// All robots, which daemon belongs to which of them, and which robot and daemon the operator has chosen. A
/// daemon is of the robot that it tells. One that tells none is of the robot whose supervisor names it, else
/// of the only one that has a supervisor on its host, else of its host, as one that has not answered yet.
/// What the operator has chosen stays chosen while it is there.
class Fleet : public QObject {
    Q_OBJECT
public:
    /// Why a robot may not be removed now; empty: it may.
    using Objection = std::function<QString(const Robot &)>;

    explicit Fleet(QObject *parent = nullptr);
    ~Fleet() override;

    /// "HOST": every daemon found there; "HOST:PORT": that one, and all others that it names when it is a
    /// supervisor. Error: it is no address.
    Result<void> add(const QString &address);
    /// All that were added, as add() takes them.
    const QStringList &addresses() const { return addresses_; }
    /// Forgets a robot and its daemons; gives what add() brings them back with. Error: why not now.
    Result<QStringList> remove(Robot *robot);
    void setObjection(const Objection &objection) { objection_ = objection; }

    const std::vector<std::unique_ptr<Robot>> &robots() const { return robots_; }
    /// Null: there is none.
    DaemonLink *daemonAt(const QString &address) const;
    /// Whose daemon it is; null: nobody's.
    Robot *robotOf(const DaemonLink *daemon) const;
    /// By its id, or by the address of a daemon that has said whose it is. Null: there is none.
    Robot *robotAt(const QString &address) const;
    /// Its name, and where another has the same its address too.
    QString titleOf(const Robot &robot) const;
    /// The name of a daemon, and where there are several robots that of its robot too.
    QString titleOf(const DaemonLink &daemon) const;

    /// What the operator calls the robots, by their ids, those too that are not here now.
    const QMap<QString, QString> &names() const { return names_; }
    void setNames(const QMap<QString, QString> &names);
    /// An empty name: what it calls itself.
    void rename(Robot &robot, const QString &name);

    Robot *robot() const { return robot_; }
    DaemonLink *daemon() const { return daemon_; }
    void choose(Robot *robot);
    void choose(DaemonLink *daemon);
    /// Chooses the robot of this id or address as soon as it is there, unless the operator has chosen before.
    void prefer(const QString &robot);
    /// What will be chosen, or is.
    QString preferred() const;
    /// Chooses it for what has become of the chosen one, unless another is preferred.
    void goAlong(Robot *robot);
    /// Whatever is chosen is meant from now on, even if nobody has chosen it.
    void keepChoice();

Q_SIGNALS:
    /// Robots or daemons came or went, or the condition of one changed.
    void changed();
    /// Null: there is none any more.
    void robotChosen(hermes::desktop::Robot *robot);
    /// Null: none of the chosen robot.
    void daemonChosen(hermes::desktop::DaemonLink *daemon);
    /// It has told another robot than before, or its supervisor is another's.
    void moved(hermes::desktop::DaemonLink *daemon, hermes::desktop::Robot *from, hermes::desktop::Robot *to);
    /// It is not one of the robots any more; successor: who stands for it now, or null.
    void robotGone(hermes::desktop::Robot *robot, hermes::desktop::Robot *successor);

private:
    using Place = Robot::Place;
    struct Entry {
        std::unique_ptr<DaemonLink> link;
        bool isAdded = false;  ///< by its address: shown although it has never answered
        bool isSought = false; ///< at its usual port: shown once it has answered
        Robot *robot = nullptr;
        Robot *namedBy = nullptr;
        std::optional<QString> told; ///< when it was put to its robot: what it says whose it is

        std::optional<QString> tells() const {
            return link->isKnown() ? std::optional(link->robotId()) : std::nullopt;
        }
        /// Shown while no supervisor names it; one that was named before until it ends.
        bool isShown() const { return isAdded || (isSought ? link->isKnown() : link->isConnected()); }
    };
    struct Move {
        DaemonLink *daemon;
        Robot *from, *to;
    };

    using Robots = std::vector<std::unique_ptr<Robot>>;

    Entry &entryAt(const Place &place);
    void onChanged(const Place &place);
    Robot *robotWith(const QString &id);

    void findNamed();
    std::vector<Move> reassign();
    Robots takeEmpty();
    /// Puts all daemons to their robots, and tells who has moved; removed: by the operator, or null.
    void distribute(std::unique_ptr<Robot> removed = nullptr);
    void tellConflicts();
    void forgetHost(const QString &host);

    Robot *successorOf(const Robot &gone, const std::vector<Move> &moves) const;
    void followChoice(const std::vector<Move> &moves, const Robots &gone);
    /// daemon: none of another robot.
    void setChosen(Robot *robot, DaemonLink *daemon);
    DaemonLink *lastDaemonOf(const Robot *robot) const;
    void touch();

    QStringList addresses_;
    QTimer changes_; // many that come together are told once
    std::map<Place, Entry> entries_;
    Robots robots_;
    QMap<QString, QString> names_;
    mutable QHash<QString, int> namesakes_; ///< how many robots have a name; empty: to be counted anew
    Objection objection_;
    Robot *robot_ = nullptr;
    QPointer<DaemonLink> daemon_;
    std::map<const Robot *, QPointer<DaemonLink>> lastDaemons_; ///< chosen of each robot
    QString preferred_;
    bool isMeant_ = false;
};

} // namespace hermes::desktop
