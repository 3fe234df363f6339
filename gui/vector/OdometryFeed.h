#pragma once

#include "vectorlib/motion/Odometry.h"

#include <functional>
#include <optional>
#include <utility>

namespace hermes::vector {

/// Takes the odometry that each scan of a recording needs from samples in the order of the recording.
class OdometryFeed {
public:
    using Next = std::function<std::optional<vectorlib::OdometrySample>()>;

    /// The robot's way during a scan (seconds), when it is known. Scans in the order of time. `next` gives
    /// one sample after the other; nothing at the end.
    std::optional<vectorlib::OdometryTrack> over(double begin, double end, const Next &next);

private:
    std::optional<vectorlib::OdometrySample> next_; ///< not yet in the buffer
    vectorlib::OdometryBuffer buffer_;
    std::optional<double> newest_, lastEnd_; ///< stamp in the buffer; of the last scan
};

} // namespace hermes::vector
