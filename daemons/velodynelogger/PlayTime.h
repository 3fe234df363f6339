#pragma once

#include <algorithm>
#include <cstdint>

namespace hermes::velodynelogger {

/// How far into a capture a record lies when it is played. Steps back and steps of more than a minute are a
/// clock that was set, not time that passed: they count as nothing.
class PlayTime {
public:
    /// Of a capture: time 0 is its first record.
    PlayTime() = default;
    /// Of a recording of a known length that begins at a stamp: time delay_ns is there, and only steps longer
    /// than the recording are a clock that was set.
    PlayTime(std::int64_t start_ns, std::int64_t length_ns, std::int64_t delay_ns)
        : longest_ns_(std::max(minute_ns, length_ns))
        , started_(true)
        , last_ns_(start_ns)
        , now_ns_(delay_ns) {}

    /// Nanoseconds after the beginning; stamps in the order of the file.
    std::int64_t advance(std::int64_t stamp_ns) {
        const std::int64_t step_ns = stamp_ns - last_ns_;
        if (started_ && step_ns > 0 && step_ns <= longest_ns_ && now_ns_ < end_ns)
            now_ns_ += step_ns;
        started_ = true;
        last_ns_ = stamp_ns;
        return now_ns_;
    }
    std::int64_t now_ns() const { return now_ns_; }

    static constexpr std::int64_t end_ns = 1000000000000000000; ///< 30 years: time stands still there

private:
    static constexpr std::int64_t minute_ns = 60000000000;
    std::int64_t longest_ns_ = minute_ns;
    bool started_ = false;
    std::int64_t last_ns_ = 0; ///< stamp
    std::int64_t now_ns_ = 0;
};

} // namespace hermes::velodynelogger
