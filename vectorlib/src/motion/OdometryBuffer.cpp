#include "vectorlib/motion/OdometryBuffer.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY OdometryBuffer::Outcome OdometryBuffer::add(const OdometrySample &added) {
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

VECTORLIB_BODY void OdometryBuffer::restart() {
    first_ = size_ = 0;
    ++epoch_;
}

VECTORLIB_BODY std::optional<OdometryTrack> OdometryBuffer::over(double begin, double end) const {
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

VECTORLIB_BODY bool OdometryBuffer::follows(const OdometrySample &before, const OdometrySample &after) {
    const double seconds = after.stamp - before.stamp;
    const double speed =
        std::max(std::hypot(before.twist.vx, before.twist.vy), std::hypot(after.twist.vx, after.twist.vy));
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

} // namespace vectorlib
