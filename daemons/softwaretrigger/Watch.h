#pragma once

#include "common/Result.h"
#include "daemons/softwaretrigger/Definition.h"
#include "daemons/softwaretrigger/Schedule.h"
#include "daemons/softwaretrigger/Targets.h"
#include "daemons/softwaretrigger/TriggerMessages.h"
#include "protocol/messages/Motion.h"
#include "protocol/wire/WireValue.h"

#include <QJsonValue>
#include <QString>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>

namespace hermes::softwaretrigger {

/// What is read of a message of an odometry topic.
struct TravelPoint {
    Pose2D pose;
    Twist2D twist;
    double mono = 0;
};

/// Adds up the way, or the turn, from the messages of an odometry topic. A pose that the speed does not
/// explain (it was set, or the daemon started anew) counts as no way; so does noise below 1 mm or 1 mrad. No
/// I/O.
class Travel {
public:
    enum class Kind { Distance, Angle };

    /// step: the way (m) or turn (rad) between two firings.
    Travel(Kind kind, double step)
        : kind_(kind)
        , step_(step) {}

    struct Passed {
        quint64 n = 0;      ///< which multiple of the step was reached last, from 1
        quint64 missed = 0; ///< multiples before it, since the last message
        Pose2D pose;
    };
    /// Takes a message. Gives the multiple of the step that it reached, if it did; InvalidParams for what is
    /// no odometry.
    Result<std::optional<Passed>> add(WireView message);
    /// The next message begins anew; what was added up stays.
    void interrupt() { last_.reset(); }

    double total() const { return sum_ + pending_; } ///< m or rad
    quint64 jumps() const { return jumps_; }         ///< poses that were not explained

private:
    double speed(const TravelPoint &at) const {
        return kind_ == Kind::Distance ? std::hypot(at.twist.vx, at.twist.vy) : std::abs(at.twist.omega);
    }
    double between(const TravelPoint &from, const TravelPoint &to) const {
        return kind_ == Kind::Distance
                   ? std::hypot(to.pose.x - from.pose.x, to.pose.y - from.pose.y)
                   : std::abs(std::remainder(to.pose.theta - from.pose.theta, 2 * vectorlib::pi));
    }

    Kind kind_;
    double step_;
    std::optional<TravelPoint> last_;   // the message before
    std::optional<TravelPoint> anchor_; // up to here it is in sum_
    double sum_ = 0, pending_ = 0;
    quint64 passed_ = 0, jumps_ = 0;
};

/// The value at a dotted path with numbers for elements of arrays; undefined where there is none. "" is the
/// whole.
QJsonValue lookUp(QJsonValue data, const QString &path);

/// Watches for a value in messages to become such that `value OP limit`.
class Condition {
public:
    Condition(QString path, QString op, QJsonValue limit)
        : path_(std::move(path))
        , op_(std::move(op))
        , limit_(std::move(limit)) {}

    /// Whether it is true now and was not before the message; the first message counts as a change. Nothing:
    /// the path is not in the message, or op does not compare what stands there; then nothing is known to
    /// have changed.
    std::optional<bool> becomesTrue(const QJsonValue &data);

private:
    std::optional<bool> holds(const QJsonValue &value) const;

    QString path_, op_;
    QJsonValue limit_;
    bool held_ = false;
};

/// Why a trigger fires now.
struct Occasion {
    std::optional<double> dueMono;  ///< the time that it fires for, by the monotonic clock
    std::optional<double> dueStamp; ///< the same, or the stamp of the message, since the Unix epoch
    quint64 missed = 0;             ///< firings before this one that did not happen, since the last
    FiringCause cause;              ///< no kind: that of the trigger
};

/// Watches for what fires one armed trigger, from its making to its end.
class Watch {
public:
    struct Listener {
        std::function<void(const Occasion &)> fire;
        std::function<void()> missed; ///< a firing was missed, and none follows now
    };
    virtual ~Watch() = default;

    /// Why it cannot watch at the moment; empty when it can.
    virtual QString problem() const { return {}; }
    /// What it has seen.
    virtual WatchedState state() const { return {}; }

    /// None for causes that need no watch: trigger, command. The daemon of the definition must be in use.
    static std::unique_ptr<Watch> make(const TriggerDefinition &definition, Schedule &schedule,
                                       Targets &targets, const Listener &listener);
};

/// The daemon whose topic a definition watches; empty for none.
QString watchedDaemon(const TriggerDefinition &definition);

} // namespace hermes::softwaretrigger
