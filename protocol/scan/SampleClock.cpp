#include "protocol/scan/SampleClock.h"

#include <algorithm>
#include <cmath>

namespace hermes::scan {
namespace {

constexpr double rateWindow_ns = 1e10; // long enough that packets that come late do not matter
constexpr double leastStep_deg = 0.01; // a head that stands nearly
constexpr double mostUnseen = 8;       // packets; of more the number is a guess
constexpr double mostGone = 100;       // revolutions

} // namespace

void SampleClock::jump() {
    clock_ = HostClock(period_ns, HostClock::Receiver::NeverJumps);
    head_deg_.reset();
    last_ns_ = 0;
    rateSince_ns_ = 0;
}

void SampleClock::expect(double head_deg, double step_deg) {
    head_deg_ = head_deg;
    step_deg_ = step_deg;
}

/// How many beams it measures is a setting of some models: the host's clock tells, where it is another than
/// is known of it. But for the first time two windows in a row must tell the same, as a
/// host that was held up reads late.
void SampleClock::followRate(double beams, std::int64_t mono_ns) {
    const double passed_ns = double(mono_ns - rateSince_ns_);
    rateBeams_ += beams;
    if (passed_ns >= 0 && passed_ns < rateWindow_ns && beams < mostUnseen * fullBeams_)
        return;
    const double each_ns = passed_ns / rateBeams_;
    const bool isPossible = each_ns > usual_ns_ / 4 && each_ns < usual_ns_ * 4;
    const auto isOther = [each_ns](double than_ns) { return std::abs(each_ns / than_ns - 1) > 0.02; };
    if (passed_ns >= rateWindow_ns && passed_ns < 2 * rateWindow_ns && isPossible) {
        if (isOther(sample_ns_) && (windowBefore_ns_ <= 0 || !isOther(windowBefore_ns_)))
            sample_ns_ = each_ns;
        windowBefore_ns_ = each_ns;
    }
    rateSince_ns_ = mono_ns;
    rateBeams_ = 0;
}

SampleClock::Time SampleClock::take(const Packet &packet) {
    fullBeams_ = std::max(fullBeams_, packet.beams);
    double missing = 0;
    std::uint64_t lost = 0;
    if (head_deg_ && step_deg_ > leastStep_deg) {
        const double around = 360 / step_deg_, apart = (packet.head_deg - *head_deg_) / step_deg_;
        const double half = fullBeams_ / 2.0; // a packet
        const double tolerance = packet.isBehindGap ? std::min(tolerance_, half) : tolerance_;
        missing = apart - around * std::floor((apart + tolerance) / around);
        if (packet.isBehindGap || missing > tolerance) {
            const double passed = double(packet.measured_ns - last_ns_) / sample_ns_ - packet.beams;
            missing = std::max(missing, 0.0);
            missing += std::clamp(std::round((passed - missing) / around), 0.0, mostGone) * around;
            const double packets = (missing - std::min(tolerance, half)) / fullBeams_;
            lost = std::uint64_t(std::max(std::ceil(packets), 1.0));
        } else {
            missing = 0;
        }
    } else if (head_deg_ && packet.isBehindGap) { // nobody knows how many
        jump();
        lost = 1;
    }
    followRate(packet.beams + missing, packet.measured_ns);
    sensor_ns_ = std::fmod(sensor_ns_ + (packet.beams + missing) * sample_ns_, double(period_ns));
    const HostClock::Time time = clock_.take(std::int64_t(sensor_ns_), packet.measured_ns, 0);
    const double slip = double(time.stamp_ns - last_ns_) / sample_ns_ - packet.beams - missing; // beams
    const double revolutions = head_deg_ ? slip * step_deg_ / 360 : 0;
    const bool slips =
        std::abs(revolutions) > 0.5 && std::abs(std::remainder(revolutions, 1)) < 0.25; // not by chance
    last_ns_ = time.stamp_ns;
    return {time.stamp_ns, time.bound_ns, lost, slips};
}

} // namespace hermes::scan
