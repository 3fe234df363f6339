#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/motion/OdometrySample.h"
#include "vectorlib/motion/OdometryTrack.h"

#include <array>
#include <cstdint>
#include <optional>

namespace vectorlib {

/// The last samples of an odometry, from which each scan takes those of its time. Of fixed size; knows no
/// clock.
class OdometryBuffer {
public:
    static constexpr std::size_t capacity = 512;           ///< ten seconds at 50 Hz
    static constexpr double longestGap_s = 0.5;            ///< over a longer one nothing is interpolated
    static constexpr double longestForesight_s = 0.1;      ///< how far the last twist is trusted
    static constexpr double jump_m = 0.05, jump_rad = 0.1; ///< beyond what twice the speed explains

    /// What became of a sample.
    enum class Outcome {
        Taken,
        OutOfOrder, ///< not later than the one before; left out
        Restarted   ///< does not follow from those before (reset, gap, clock set): a new epoch begins with it
    };
    /// Takes the next sample.
    Outcome add(const OdometrySample &added);
    /// What comes next does not follow from what was.
    void restart();

    /// The way from begin to end (seconds since the Unix epoch), when it is known.
    std::optional<OdometryTrack> over(double begin, double end) const;

private:
    const OdometrySample &sample(std::size_t i) const {
        return ring_[(first_ + i) % capacity];
    } // 0 is the oldest
    static bool follows(const OdometrySample &before, const OdometrySample &after);

    std::array<OdometrySample, capacity> ring_;
    std::size_t first_ = 0, size_ = 0;
    std::uint64_t epoch_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/motion/OdometryBuffer.cpp")
