#include "daemons/softwaretrigger/Travel.h"

#include "protocol/wire/Fields.h"

#include <algorithm>
#include <cmath>

namespace hermes::softwaretrigger {
namespace {

constexpr double noise = 1e-3;     // m or rad
constexpr double allowance = 0.05; // m or rad that a step may exceed what the speed explains

} // namespace

const Fields<TravelPoint> &fieldsOf(Of<TravelPoint>) {
    static const auto fields = Fields<TravelPoint>()
                                   .add("pose", &TravelPoint::pose, "As in odometry")
                                   .add("twist", &TravelPoint::twist, "As in odometry")
                                   .add("mono", &TravelPoint::mono, "As in odometry", "s");
    return fields;
}

double Travel::speed(const TravelPoint &at) const {
    return kind_ == Kind::Distance ? std::hypot(at.twist.vx, at.twist.vy) : std::abs(at.twist.omega);
}

double Travel::between(const TravelPoint &from, const TravelPoint &to) const {
    return kind_ == Kind::Distance
               ? std::hypot(to.pose.x - from.pose.x, to.pose.y - from.pose.y)
               : std::abs(std::remainder(to.pose.theta - from.pose.theta, 2 * vectorlib::pi));
}

Result<std::optional<Travel::Passed>> Travel::add(WireView message) {
    ReadReport report;
    const auto now = readMessage<TravelPoint>(message, report);
    if (!now)
        return Error(ErrorCode::InvalidParams, "no odometry: " + report.text());
    if (last_) {
        const double fastest = std::max(speed(*last_), speed(*now));
        const double explained = 2 * fastest * (now->mono - last_->mono) + allowance;
        if (now->mono <= last_->mono || between(*last_, *now) > explained) {
            ++jumps_;
            last_.reset();
        }
    }
    if (!last_) {
        sum_ += pending_;
        anchor_ = now;
    }
    last_ = now;
    pending_ = between(*anchor_, *now);
    if (pending_ >= noise) {
        sum_ += pending_;
        pending_ = 0;
        anchor_ = now;
    }
    // One part in 1e9: the sum of many small steps may fall short by rounding.
    const auto reached = quint64(std::floor(total() / step_ * (1 + 1e-9)));
    if (reached <= passed_)
        return std::optional<Passed>();
    const Passed result{reached, reached - passed_ - 1, now->pose};
    passed_ = reached;
    return std::optional<Passed>(result);
}

} // namespace hermes::softwaretrigger
