#pragma once

#include <cstdint>

namespace hermes {

/// How far into a capture a record lies when it is played. Steps back and steps of more than a minute are a
/// clock that was set, not time that passed: they count as nothing.
class PlayTime {
public:
    /// Nanoseconds after the first record; stamps in the order of the file.
    std::int64_t advance(std::int64_t stamp_ns) {
        const std::int64_t step_ns = stamp_ns - last_ns_;
        if (started_ && step_ns > 0 && step_ns <= longest_ns)
            now_ns_ += step_ns;
        started_ = true;
        last_ns_ = stamp_ns;
        return now_ns_;
    }
    std::int64_t now_ns() const { return now_ns_; }

private:
    static constexpr std::int64_t longest_ns = 60000000000;

    bool started_ = false;
    std::int64_t last_ns_ = 0; ///< stamp
    std::int64_t now_ns_ = 0;
};

} // namespace hermes
