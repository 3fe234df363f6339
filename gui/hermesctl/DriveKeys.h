#pragma once

#include "protocol/messages/Motion.h"

#include <QByteArray>

namespace hermes::ctl {

/// What the keys pressed at a terminal ask of a robot. A terminal tells of no key that is let go, so what a
/// key asks for holds for a moment only; the way and the turn apart, so that two keys in turn drive a bend.
/// It repeats only the key that was pressed last: a car, which turns only on its way, drives with it, too.
class DriveKeys {
public:
    static constexpr double held_s = 0.3;
    static constexpr const char *help = "arrows or W A S D drive while they are pressed, + and - change the "
                                        "speed, Q ends; any other key stops";
    enum class Action { None, Stop, Quit };

    explicit DriveKeys(bool isCar)
        : isCar_(isCar) {}

    /// The bytes of a terminal; an escape sequence may come in pieces. now: seconds of a clock that never
    /// jumps. What is no key of ours stops.
    Action take(const QByteArray &bytes, double now);
    /// m/s and rad/s; zero when no key came for held_s.
    Twist2D request(double now) const;

private:
    struct Axis {
        double sign = 0;
        double until = 0; ///< holds before it
    };

    Action takeOne(char key, double now);
    Action press(Axis &axis, double sign, double now);
    Action turn(double sign, double now);
    Action stop();

    bool isCar_;
    Axis way_, turn_;
    double speed_ = 0.2;  // m/s
    QByteArray sequence_; // an escape sequence so far
};

} // namespace hermes::ctl
