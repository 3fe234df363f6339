#pragma once

#include "common/Result.h"

#include <QJsonValue>
#include <optional>

namespace hermes {

/// Adds up the way, or the turn, from the messages of an odometry topic: {pose {x, y, theta}, twist {vx, vy,
/// omega}, mono}. A pose that the speed does not explain (it was set, or the daemon started anew) counts as
/// no way; so does noise below 1 mm or 1 mrad. No I/O.
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
    };
    /// Takes a message. Gives the multiple of the step that it reached, if it did; InvalidParams for what is
    /// no odometry.
    Result<std::optional<Passed>> add(const QJsonValue &message);
    /// The next message begins anew; what was added up stays.
    void interrupt() { last_.reset(); }

    double total() const { return sum_ + pending_; } ///< m or rad
    quint64 jumps() const { return jumps_; }         ///< poses that were not explained

private:
    struct State {
        double x, y, theta, speed, mono;
    };
    static std::optional<State> read(const QJsonValue &message, Kind kind);
    double between(const State &from, const State &to) const;

    Kind kind_;
    double step_;
    std::optional<State> last_;   // the message before
    std::optional<State> anchor_; // up to here it is in sum_
    double sum_ = 0, pending_ = 0;
    quint64 passed_ = 0, jumps_ = 0;
};

} // namespace hermes
