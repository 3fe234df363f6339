#pragma once

#include <optional>

namespace hermes::motorcontrol {

/// Notices that commands have stopped to come. Times are seconds of a clock that never jumps.
class CommandWatchdog {
public:
    void setTimeout(double seconds) { timeout_ = seconds; }

    /// A command came; from now on they are expected.
    void feed(double now) { last_ = now; }
    /// No more are expected.
    void rest() { last_.reset(); }
    /// Whether the last one is older than the time-out.
    bool hasExpired(double now) const { return last_ && now - *last_ >= timeout_; }

private:
    double timeout_ = 0.25;
    std::optional<double> last_;
};

} // namespace hermes::motorcontrol
