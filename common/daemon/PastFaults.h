#pragma once

#include "common/Time.h"
#include "common/daemon/Health.h"

namespace hermes {

/// How a health item tells of what went wrong and is over, lost packets for example: a warning for a minute,
/// then a count.
class PastFaults {
public:
    static constexpr double window_s = 60;

    /// count: as it stands now. Warn when it has grown in the last minute, as far as it was looked at, else
    /// Ok. A smaller count than before has begun anew.
    HealthLevel level(double count, double mono = monotonicNow()) {
        if (count > count_ || (count < count_ && count > 0))
            grown_ = mono;
        count_ = count;
        return count_ > 0 && mono - grown_ < window_s ? HealthLevel::Warn : HealthLevel::Ok;
    }

private:
    double count_ = 0;
    double grown_ = 0; // on the monotonic clock
};

} // namespace hermes
