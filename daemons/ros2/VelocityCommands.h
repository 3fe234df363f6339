#pragma once

#include "common/client/ClockOffset.h"
#include "common/daemon/GapWatch.h"
#include "common/daemon/RobotDaemons.h"
#include "daemons/ros2/Participant.h"
#include "protocol/messages/Motion.h"

#include <map>

namespace hermes::ros2 {

/// Velocities that ROS commands go to the motor control, as those of any client. The control is acquired with
/// the first command when nobody holds it, and ends by itself when commands stay away. Once it was refused,
/// or taken by somebody, or the robot was stopped, the commands that go on do not move the robot: a pause of
/// a second must come first. One node commands at a time; commands of others are dropped until it has paused.
class VelocityCommands : public QObject {
public:
    VelocityCommands(RobotDaemons &daemons, GapWatch &gaps)
        : daemons_(daemons)
        , gaps_(gaps) {}

    /// velocity: in the robot's frame. written_s: when the sample was written, by the writer's clock. age_s:
    /// how old it was then. node: for people, "ROS /teleop".
    void take(const Twist2D &velocity, const Guid &writer, double written_s, double age_s,
              const QString &node);

    struct Counts {
        quint64 taken = 0;
        quint64 late = 0;    ///< more than maxAge_s on the way
        quint64 others = 0;  ///< of a second node
        quint64 refused = 0; ///< by the motor control, or as a pause was due
    };
    const Counts &counts() const { return counts_; }
    const QString &node() const { return node_; } ///< that commands, or did
    const QString &refusal() const {
        return refusal_;
    } ///< why commands do not move the robot; empty: they do

    static constexpr double maxAge_s = 0.25; ///< as safety.command_timeout_s has it
    static constexpr double pause_s = 1;

private:
    enum class State { Idle, Acquiring, Driving, Refused };
    struct Command {
        Twist2D velocity;
        double stamp; ///< when it was made, by this host's clock
    };

    double delayOf(const Guid &writer, double written_s);
    void acquire();
    void drive(const Command &command);
    void refuse(const QString &why);

    RobotDaemons &daemons_;
    GapWatch &gaps_;
    State state_ = State::Idle;
    Guid writer_{};
    QString node_, refusal_;
    double last_ = 0; ///< command of this writer; of monotonicNow()
    Command newest_{};
    std::map<Guid, ClockOffset> clocks_; ///< of writers
    Counts counts_;
};

/// The motor control of the robot; null: none answers.
Client *motorControl(const RobotDaemons &daemons);

} // namespace hermes::ros2
