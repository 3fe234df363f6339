#include "protocol/scan/RevolutionAssembler.h"

#include <algorithm>
#include <cmath>

namespace hermes::scan {
namespace {

constexpr std::size_t maxBeams = 100000;              // of a head that does not turn
constexpr std::int64_t settling_ns = 3000000000;      // of a clock after a gap
constexpr std::int64_t longestCount_ns = 20000000000; // by one period, which is not exact
constexpr int perPeriod = 8;                          // revolutions that it is measured by

} // namespace

double RevolutionAssembler::revolutionsOf(std::int64_t time_ns) const {
    return period_ns_ > 0 ? double(time_ns) / double(period_ns_) : 0;
}

/// Counts those that end here. What is missing is counted by the time since: packets come late after a gap,
/// which shows by those that come later, so that it is counted anew until the clock has settled. usual:
/// revolutions from one passage to the next.
void RevolutionAssembler::count(bool ends, const Passage &now, double usual) {
    const double gap = last_ && period_ns_ > 0 ? revolutionsOf(now.stamp_ns - last_->stamp_ns) - usual : 0;
    if (std::abs(gap) > 0.1) // the clock was corrected, or something is missing
        inARow_ = 0;
    const bool isLong = std::abs(gap) > 0.5;
    if (isLong && (isGap_ || isSlip_) && (!before_ || now.stamp_ns > before_->stamp_ns + longestCount_ns)) {
        before_ = last_;
        turnedBefore_ = turned_;
    }
    if (isLong)
        settled_ns_ = now.stamp_ns + settling_ns;
    last_ = now;
    turned_ += ends;
    if (before_)
        turned_ = turnedBefore_ + std::llround(revolutionsOf(now.stamp_ns - before_->stamp_ns) -
                                               (now.head_deg - before_->head_deg) / 360);
    turned_ = std::max(turned_, std::int64_t(counts_.revolutions + counts_.partial));
    if (now.stamp_ns > settled_ns_)
        before_.reset();
}

void RevolutionAssembler::addClockwise(double head_deg, double angle_deg, float range_m,
                                       std::uint8_t intensity, std::int64_t stamp_ns) {
    spins_ = true;
    if (revolution_.beams.size() >= maxBeams)
        jump();
    bool ends = last_ && last_->head_deg - head_deg > 180;
    if (const std::int64_t passed_ns = last_ ? stamp_ns - last_->stamp_ns : 0;
        std::abs(revolutionsOf(passed_ns)) > 0.5) {
        if (isGap_)
            ends = std::abs(revolutionsOf(passed_ns) - (head_deg - last_->head_deg) / 360) > 0.5;
        else
            for (Beam &beam : revolution_.beams) // the clock is corrected
                beam.stamp_ns += passed_ns;
    }
    count(ends, {stamp_ns, head_deg}, 0);
    if (ends)
        deliver();
    revolution_.partial = revolution_.partial || isGap_;
    isGap_ = isSlip_ = false;
    revolution_.beams.push_back(
        {std::remainder(head_deg - angle_deg, 360) - head_deg, range_m, intensity, stamp_ns});
}

void RevolutionAssembler::endSweep() {
    if (!revolution_.beams.empty()) {
        count(true, {revolution_.beams.front().stamp_ns, 0}, 1);
        revolution_.number = std::max(revolution_.number, std::uint64_t(turned_ - 1));
        isGap_ = false;
    }
    deliver();
}

void RevolutionAssembler::lose(std::uint64_t packets) {
    revolution_.lostPackets += packets;
    revolution_.partial = true;
    counts_.lostPackets += packets;
    isGap_ = true;
    inARow_ = 0;
}

void RevolutionAssembler::jump() {
    lose(0);
    deliver();
}

void RevolutionAssembler::seek() {
    jump();
    last_.reset();
    before_.reset();
}

void RevolutionAssembler::deliver() {
    if (!revolution_.beams.empty()) {
        const auto [first, last] =
            std::minmax_element(revolution_.beams.begin(), revolution_.beams.end(),
                                [](const Beam &a, const Beam &b) { return a.stamp_ns < b.stamp_ns; });
        followPeriod(first->stamp_ns);
        revolution_.begin_ns = first->stamp_ns + ahead_ns_;
        revolution_.end_ns = last->stamp_ns + ahead_ns_;
        for (Beam &beam : revolution_.beams)
            beam.stamp_ns += ahead_ns_;
        if (spins_)
            std::sort(revolution_.beams.begin(), revolution_.beams.end(),
                      [](const Beam &a, const Beam &b) { return a.angle_deg < b.angle_deg; });
        revolution_.clockBound_ns = bound_ns_;
        ++(revolution_.partial ? counts_.partial : counts_.revolutions);
        sink_(revolution_);
        revolution_.number = std::max(revolution_.number + 1, std::uint64_t(turned_));
    }
    revolution_.partial = false;
    revolution_.lostPackets = 0;
    revolution_.beams.clear();
}

/// By some in a row, as stamps may be coarse; and the median, as these seem longer where a clock is
/// corrected.
void RevolutionAssembler::followPeriod(std::int64_t begin_ns) {
    inARow_ = revolution_.partial ? 0 : inARow_ + 1;
    if (inARow_ <= 1 || begin_ns <= begin_ns_) {
        begin_ns_ = begin_ns;
    } else if (const int passed = inARow_ - 1; passed == perPeriod || periods_ == 0) {
        periods_ns_[periods_++ % periods_ns_.size()] = (begin_ns - begin_ns_) / passed;
        auto sorted = periods_ns_;
        const auto end = sorted.begin() + std::ptrdiff_t(std::min(periods_, sorted.size()));
        const auto middle = sorted.begin() + (end - sorted.begin()) / 2;
        std::nth_element(sorted.begin(), middle, end);
        period_ns_ = *middle;
        begin_ns_ = begin_ns;
        inARow_ = 1;
    }
}

RevolutionAssembler::Counts RevolutionAssembler::counts() const {
    Counts counts = counts_;
    counts.missed =
        std::uint64_t(std::max<std::int64_t>(turned_ - std::int64_t(counts.revolutions + counts.partial), 0));
    return counts;
}

} // namespace hermes::scan
