#include "gui/vector/OdometryFeed.h"

namespace hermes::vector {

namespace {

constexpr double clockStep_s = 0.5;   // back: the clock was set
constexpr double longestLead_s = 1.0; // of an odometry before a scan: else its stamp is wrong

} // namespace

// Samples are taken until one is not earlier than the end of the scan. Where the clock was set back, those
// that follow are of the scans that follow.
std::optional<vectorlib::OdometryTrack> OdometryFeed::over(double begin, double end, const Next &next) {
    const bool goesBack = lastEnd_ && end < *lastEnd_ - clockStep_s;
    lastEnd_ = end;
    for (;;) {
        if (!next_)
            next_ = next();
        const bool isBehind = !newest_ || *newest_ < end;
        const bool isSetBack = next_ && newest_ && next_->stamp < *newest_ - clockStep_s;
        if (!next_ || !(isBehind || (isSetBack && (goesBack || *newest_ > end + longestLead_s))))
            return buffer_.over(begin, end);
        buffer_.add(*next_);
        newest_ = next_->stamp;
        next_.reset();
    }
}

} // namespace hermes::vector
