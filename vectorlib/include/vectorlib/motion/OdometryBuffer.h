#pragma once

#include "vectorlib/motion/OdometryTrack.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vectorlib {

/// The last samples of an odometry, from which each scan takes those of its time. Of fixed size; knows no
/// clock.
class OdometryBuffer {
public:
    static constexpr std::size_t capacity = 512;           ///< ten seconds at 50 Hz
    static constexpr double longestGap_s = 0.5;            ///< over a longer one nothing is interpolated
    static constexpr double longestForesight_s = 0.1;      ///< how far the last twist is trusted
    static constexpr double jump_m = 0.05, jump_rad = 0.1; ///< beyond what twice the speed explains

    /// What became of a sample.
    enum class Outcome {
        Taken,
        OutOfOrder, ///< not later than the one before; left out
        Restarted   ///< does not follow from those before (reset, gap, clock set): a new epoch begins with it
    };
    /// Takes the next sample.
    Outcome add(const OdometrySample &added) {
        Outcome outcome = Outcome::Taken;
        if (size_ > 0) {
            const OdometrySample &last = sample(size_ - 1);
            if (added.stamp <= last.stamp && added.stamp >= last.stamp - longestGap_s)
                return Outcome::OutOfOrder;
            if (!follows(last, added)) {
                restart();
                outcome = Outcome::Restarted;
            }
        }
        if (size_ == capacity)
            first_ = (first_ + 1) % capacity;
        else
            ++size_;
        ring_[(first_ + size_ - 1) % capacity] = added;
        return outcome;
    }
    /// What comes next does not follow from what was.
    void restart() {
        first_ = size_ = 0;
        ++epoch_;
    }

    /// The way from begin to end (seconds since the Unix epoch), when it is known.
    std::optional<OdometryTrack> over(double begin, double end) const {
        if (size_ == 0 || !(begin <= end) || sample(0).stamp > begin ||
            sample(size_ - 1).stamp < end - longestForesight_s)
            return std::nullopt;
        std::size_t from = size_ - 1;
        while (from > 0 && sample(from).stamp > begin)
            --from;
        std::vector<OdometrySample> samples;
        for (std::size_t i = from; i < size_; ++i) {
            samples.push_back(sample(i));
            if (sample(i).stamp >= end)
                break;
        }
        return OdometryTrack(epoch_, std::move(samples));
    }

private:
    const OdometrySample &sample(std::size_t i) const {
        return ring_[(first_ + i) % capacity];
    } // 0 is the oldest
    static bool follows(const OdometrySample &before, const OdometrySample &after) {
        const double seconds = after.stamp - before.stamp;
        const double speed = std::max(std::hypot(before.twist.vx, before.twist.vy),
                                      std::hypot(after.twist.vx, after.twist.vy));
        const double rate = std::max(std::abs(before.twist.omega), std::abs(after.twist.omega));
        const double way = std::hypot(after.pose.x - before.pose.x, after.pose.y - before.pose.y);
        const double turn = std::abs(wrapAngle(after.pose.theta - before.pose.theta));
        // Nothing but a reset makes the heading more certain.
        const bool surer =
            before.covariance && after.covariance && (*after.covariance)(2, 2) < (*before.covariance)(2, 2);
        return std::abs(seconds) <= longestGap_s && way <= jump_m + 2 * speed * seconds &&
               turn <= jump_rad + 2 * rate * seconds && !surer &&
               before.covariance.has_value() == after.covariance.has_value();
    }

    std::array<OdometrySample, capacity> ring_;
    std::size_t first_ = 0, size_ = 0;
    std::uint64_t epoch_ = 0;
};

} // namespace vectorlib
