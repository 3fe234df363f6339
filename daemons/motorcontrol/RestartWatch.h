#pragma once

#include "protocol/drive/Bus.h"
#include "protocol/drive/MotorDevice.h"

#include <array>
#include <cmath>

namespace hermes::motorcontrol {

/// Whether the encoder counts of a device show that it was started anew, where nothing else does: they jump
/// farther than wheels turn. One reading alone may be damaged, or late.
class RestartWatch {
    using Counts = std::array<std::uint32_t, 2>;

public:
    enum class Verdict { Plausible, ReadAgain, Restarted };

    /// Nothing is known of its counts.
    void begin() { isKnown_ = isJump_ = isLate_ = false; }
    /// An answer was damaged or did not come: the next may be one that was asked for before.
    void missed() { isLate_ = true; }
    /// Of counts that were read. fastest: counts/s that no wheel exceeds.
    Verdict judge(const Counts &counts, const drive::Bus::Outcome &outcome, double fastest) {
        const double seconds = outcome.received - asked_; // at most
        if (isKnown_ && !isNear(last_, counts, fastest * seconds)) {
            const bool isRestart = isJump_ && isNear(jump_, counts, fastest * seconds);
            isJump_ = true;
            jump_ = counts;
            return isRestart ? Verdict::Restarted : Verdict::ReadAgain;
        }
        isJump_ = false;
        isKnown_ = true;
        last_ = counts;
        if (!isLate_ || asked_ == 0)
            asked_ = outcome.sent;
        isLate_ = false;
        return Verdict::Plausible;
    }

    /// Both counts are again near 0, and jumped there: a device with a checksum needs no second reading, and
    /// one that has lost its time-out is to be stopped before its next slow reading tells.
    static bool beganAnew(const drive::Readings &before, const Counts &counts,
                          const drive::Bus::Outcome &outcome, double fastest) {
        const double most = fastest * (outcome.received - before.countsTime);
        return before.countsTime > 0 && isNear({}, counts, most) && !isNear(before.counts, counts, most);
    }

private:
    static bool isNear(const Counts &before, const Counts &now, double most) {
        for (std::size_t i = 0; i < before.size(); ++i)
            if (std::abs(double(std::int32_t(now[i] - before[i]))) > most)
                return false;
        return true;
    }

    bool isKnown_ = false, isJump_ = false, isLate_ = false;
    Counts last_{}, jump_{};
    double asked_ = 0; ///< since then what was read last was counted, at the earliest
};

} // namespace hermes::motorcontrol
