#pragma once

#include "gui/desktop/drive/StopLine.h"
#include "gui/desktop/model/Fleet.h"

#include <memory>

namespace hermes::desktop {

/// STOP for the chosen robot: every daemon of it that has an emergency stop gets it, those too that are away
/// at this moment or are found later. It goes on until the robot has measured that it stands, whatever robot
/// is chosen meanwhile.
class StopControl : public QObject {
    Q_OBJECT
public:
    /// Unconfirmed for longer it is said aloud.
    static constexpr double late_s = 0.5;

    explicit StopControl(Fleet &fleet, QObject *parent = nullptr);

    void press();
    /// Of the chosen robot.
    void release();

    /// Of the chosen robot: of the line that is least far.
    StopPhase phase() const;
    /// Of any robot.
    bool isLate() const;
    /// One was pressed, for any robot, and is not confirmed as yet.
    bool isOnItsWay() const;
    /// A STOP for this robot was pressed here, and is not released as yet: another that holds it was pressed
    /// elsewhere, before this program was started, or came behind its release.
    bool isPressedFor(const Robot *robot) const { return pressed_.contains(robot); }
    /// What the operator has to know now; empty: nothing.
    QString text() const;

Q_SIGNALS:
    void changed();

private:
    void follow();
    void reach(DaemonLink *daemon);
    void onMoved(const DaemonLink *daemon, const Robot *from, const Robot *to);
    void onRobotGone(const Robot *robot, const Robot *successor);
    void onChanged(const StopLine *stop);
    /// With the robot that it is of.
    struct Line {
        const Robot *robot;
        std::unique_ptr<StopLine> stop;
    };

    /// It was pressed for a robot of which nobody can be stopped.
    bool reachesNobody() const;
    const StopLine *worst(bool ofAny) const;
    QString textOf(const StopLine &line) const;

    Fleet &fleet_;
    std::vector<Line> lines_;
    QSet<const Robot *>
        pressed_; ///< for whoever of them comes later, too; null: of the robot that is found first
};

} // namespace hermes::desktop
