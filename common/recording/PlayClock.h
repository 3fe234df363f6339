#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace hermes {

/// The time of a replay, which goes on at a speed, or waits.
class PlayClock {
public:
    using Clock = std::chrono::steady_clock;

    /// Waits at a time, in nanoseconds, until run(). speed: above 0.
    void set(std::int64_t time_ns, double speed) {
        begin_ns_ = time_ns;
        speed_ = speed;
        runs_ = false;
    }
    void run() {
        if (!runs_)
            since_ = Clock::now();
        runs_ = true;
    }
    void hold() {
        if (runs_)
            begin_ns_ += std::int64_t(
                std::chrono::duration<double, std::nano>(Clock::now() - since_).count() * speed_);
        runs_ = false;
    }
    /// When a time of the replay comes, if it runs on.
    Clock::time_point due(std::int64_t time_ns) const {
        const double wait_ns = double(time_ns - begin_ns_) / speed_;
        return since_ + std::chrono::nanoseconds(std::int64_t(std::min(wait_ns, longest_ns)));
    }

private:
    static constexpr double longest_ns = 1e18; // 30 years

    Clock::time_point since_;
    std::int64_t begin_ns_ = 0; ///< the time of the replay at since_
    double speed_ = 1;
    bool runs_ = false;
};

} // namespace hermes
