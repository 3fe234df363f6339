#pragma once

#include <QTime>
#include <QtGlobal>

namespace hermes::softwaretrigger {

/// When a daily time comes, by a wall clock that may be set at any moment. No I/O: told the time, in seconds
/// since the epoch. A time that a step forward jumps over, or that is noticed more than a second late, is
/// missed, not made up for; one that a step back of less than 12 hours brings again does not fire again.
class DayTime {
public:
    static constexpr double tolerance_s = 1;
    struct Verdict {
        bool fires = false;
        bool missed = false;
        double due = 0; ///< the time that was judged
    };

    DayTime(const QTime &at, bool utc, double now);
    /// The next time, seconds since the epoch.
    double next() const { return next_; }
    /// To be asked at next(), and after each step of the clock.
    Verdict judge(double now);

private:
    double firstAfter(double stamp) const;

    QTime at_;
    bool utc_;
    double next_;
    double last_ = 0; // that fired
};

} // namespace hermes::softwaretrigger
