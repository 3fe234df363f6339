#pragma once

#include "protocol/messages/Motion.h"

#include <QMap>
#include <QString>
#include <algorithm>

namespace hermes::desktop {

/// What stick, keys and gamepad request together, and whether all of them were at rest since a drive has
/// ended. A release that a press follows at once is none: keyboards that repeat a held key send such pairs.
class DriveInputs {
public:
    void steer(const QString &input, const Twist2D &request, bool isHeld) {
        inputs_[input] = {request, isHeld};
        if (isHeld)
            rest_ = 0;
    }
    bool isAnyHeld() const {
        return std::any_of(inputs_.begin(), inputs_.end(), [](const Input &input) { return input.isHeld; });
    }
    /// Each from -1 to 1.
    Twist2D request() const {
        Twist2D sum;
        for (const Input &input : inputs_) {
            if (!input.isHeld)
                continue;
            sum.vx += input.request.vx;
            sum.vy += input.request.vy;
            sum.omega += input.request.omega;
        }
        return {qBound(-1.0, sum.vx, 1.0), qBound(-1.0, sum.vy, 1.0), qBound(-1.0, sum.omega, 1.0)};
    }

    /// No input counts before all were at rest.
    void needRest() { mustRest_ = rest_ < wholeRest; }
    bool mustRest() const { return mustRest_; }
    /// To be called each 50 ms. Turns are counted, and not the time: in one that is held up, a press may wait
    /// that follows the release.
    void tick() {
        rest_ = isAnyHeld() ? 0 : std::min(rest_ + 1, wholeRest);
        mustRest_ = mustRest_ && rest_ < wholeRest;
    }

private:
    static constexpr int wholeRest = 3; // turns

    struct Input {
        Twist2D request;
        bool isHeld = false;
    };

    QMap<QString, Input> inputs_;
    int rest_ = wholeRest;
    bool mustRest_ = false;
};

} // namespace hermes::desktop
