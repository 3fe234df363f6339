#pragma once

#include <algorithm>
#include <deque>

namespace hermes {

/// How far the clock of a robot is ahead of the one here, in seconds. Messages that the robot stamps come
/// late by at least the way through the network; the least late of the last seconds tells the difference of
/// the clocks.
class ClockOffset {
public:
    static constexpr double window_s = 10;

    /// stamp: of the message, on the robot's clock; now: here; latency_s: there and back.
    void add(double stamp, double now, double latency_s) {
        while (!samples_.empty() && (samples_.front().time < now - window_s || samples_.front().time > now))
            samples_.pop_front();
        samples_.push_back({now, stamp - now});
        latency_s_ = std::max(0.0, latency_s);
    }
    double seconds() const {
        double ahead = samples_.empty() ? 0 : samples_.front().ahead;
        for (const Sample &sample : samples_)
            ahead = std::max(ahead, sample.ahead);
        return samples_.empty() ? 0 : ahead + latency_s_ / 2;
    }

private:
    struct Sample {
        double time, ahead;
    };
    std::deque<Sample> samples_;
    double latency_s_ = 0;
};

} // namespace hermes
