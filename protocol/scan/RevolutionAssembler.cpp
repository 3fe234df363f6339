#include "protocol/scan/RevolutionAssembler.h"

#include <algorithm>
#include <cmath>

namespace hermes::scan {
namespace {

constexpr std::size_t maxBeams = 100000;          // of a head that does not turn
constexpr std::int64_t longestGap_ns = 500000000; // between two beams

} // namespace

void RevolutionAssembler::addClockwise(double head_deg, double angle_deg, float range_m,
                                       std::uint8_t intensity, std::int64_t stamp_ns) {
    if (!revolution_.beams.empty() && std::abs(stamp_ns - revolution_.beams.back().stamp_ns) > longestGap_ns)
        jump(); // a clock was set
    if (spins_ && revolution_.beams.size() >= maxBeams)
        jump();
    if (spins_ && head_deg_ - head_deg > 180)
        deliver();
    revolution_.partial = revolution_.partial || !spins_; // it begins anywhere
    spins_ = true;
    head_deg_ = head_deg;
    revolution_.beams.push_back(
        {std::remainder(head_deg - angle_deg, 360) - head_deg, range_m, intensity, stamp_ns});
}

void RevolutionAssembler::lose(std::uint64_t packets) {
    revolution_.lostPackets += packets;
    revolution_.partial = true;
    counts_.lostPackets += packets;
}

void RevolutionAssembler::jump() {
    revolution_.partial = true;
    deliver();
    spins_ = false;
}

void RevolutionAssembler::deliver() {
    const bool isEmpty = revolution_.beams.empty();
    if (!isEmpty) {
        const auto [first, last] =
            std::minmax_element(revolution_.beams.begin(), revolution_.beams.end(),
                                [](const Beam &a, const Beam &b) { return a.stamp_ns < b.stamp_ns; });
        revolution_.begin_ns = first->stamp_ns;
        revolution_.end_ns = last->stamp_ns;
        if (spins_)
            std::sort(revolution_.beams.begin(), revolution_.beams.end(),
                      [](const Beam &a, const Beam &b) { return a.angle_deg < b.angle_deg; });
        revolution_.clockBound_ns = bound_ns_;
        ++(revolution_.partial ? counts_.partial : counts_.revolutions);
        sink_(revolution_);
    }
    revolution_.number += !isEmpty;
    revolution_.partial = false;
    revolution_.lostPackets = 0;
    revolution_.beams.clear();
}

} // namespace hermes::scan
