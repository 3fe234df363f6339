#pragma once

#include "common/Result.h"
#include "protocol/messages/Motion.h"
#include "protocol/wire/WireValue.h"

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
    double speed(const TravelPoint &at) const;
    double between(const TravelPoint &from, const TravelPoint &to) const;

    Kind kind_;
    double step_;
    std::optional<TravelPoint> last_;   // the message before
    std::optional<TravelPoint> anchor_; // up to here it is in sum_
    double sum_ = 0, pending_ = 0;
    quint64 passed_ = 0, jumps_ = 0;
};

} // namespace hermes::softwaretrigger
