#include "daemons/softwaretrigger/Travel.h"

#include "common/schema/SchemaText.h"

#include <QJsonObject>
#include <algorithm>
#include <cmath>

namespace hermes {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double noise = 1e-3;     // m or rad
constexpr double allowance = 0.05; // m or rad that a step may exceed what the speed explains

} // namespace

std::optional<Travel::State> Travel::read(const QJsonValue &message, Kind kind) {
    const QJsonValue pose = message["pose"], twist = message["twist"];
    const QJsonValue values[] = {pose["x"],   pose["y"],      pose["theta"],  twist["vx"],
                                 twist["vy"], twist["omega"], message["mono"]};
    for (const QJsonValue &value : values) {
        if (!value.isDouble() || !std::isfinite(value.toDouble()))
            return std::nullopt;
    }
    const double speed = kind == Kind::Distance ? std::hypot(values[3].toDouble(), values[4].toDouble())
                                                : std::abs(values[5].toDouble());
    return State{values[0].toDouble(), values[1].toDouble(), values[2].toDouble(), speed,
                 values[6].toDouble()};
}

double Travel::between(const State &from, const State &to) const {
    return kind_ == Kind::Distance ? std::hypot(to.x - from.x, to.y - from.y)
                                   : std::abs(std::remainder(to.theta - from.theta, 2 * pi));
}

Result<std::optional<Travel::Passed>> Travel::add(const QJsonValue &message) {
    const auto now = read(message, kind_);
    if (!now)
        return Error(ErrorCode::InvalidParams,
                     "expected pose {x, y, theta}, twist {vx, vy, omega} and mono, found " + shown(message));
    if (last_) {
        const double fastest = std::max(last_->speed, now->speed);
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
    const Passed result{reached, reached - passed_ - 1};
    passed_ = reached;
    return std::optional<Passed>(result);
}

} // namespace hermes
