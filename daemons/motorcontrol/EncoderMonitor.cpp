#include "daemons/motorcontrol/EncoderMonitor.h"

#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {

namespace {

constexpr double longestPause_s = 0.25; // between two readings; after more the controller is lost
constexpr double pushing = 0.5;         // duty: so much turns a free wheel, however slow its command is
constexpr double forgetting = 0.02;     // of the time in which nothing shows how the wheel follows

} // namespace

EncoderMonitor::Mismatch EncoderMonitor::compare(double commanded, double measured, double duty) const {
    const bool moves = !(std::abs(measured) < settings_.moving); // also when it is no number
    if (commanded != 0 && !moves && std::abs(duty) >= pushing && std::abs(measured) < std::abs(commanded) / 2)
        return Mismatch::StandsStill;
    if (measured >= slowest_ - settings_.moving && measured <= fastest_ + settings_.moving)
        return Mismatch::None;
    const bool told = std::abs(commanded) >= settings_.commanded;
    if (told && !moves)
        return Mismatch::StandsStill;
    if (told && commanded * measured < 0)
        return Mismatch::MovesBackwards;
    // Also of a slow command: a control of the velocity that runs away, as with an encoder that counts
    // backward.
    if (!(std::abs(measured - commanded) <= std::abs(commanded) + settings_.commanded) && commanded != 0)
        return commanded * measured < 0 ? Mismatch::MovesBackwards : Mismatch::MovesTooFast;
    return commanded == 0 && moves ? Mismatch::MovesUncommanded : Mismatch::None;
}

EncoderMonitor::Mismatch EncoderMonitor::judge(double commanded, double measured, double now, double duty) {
    const double step = last_ > 0 ? std::clamp(now - last_, 0.0, longestPause_s) : 0;
    const double braked = last_ > 0 ? settings_.deceleration * step : HUGE_VAL;
    if (last_ <= 0)
        told_ = {commanded, commanded};
    last_ = now;
    slowest_ = std::min({commanded, told_[0], told_[1], slowest_ + braked});
    fastest_ = std::max({commanded, told_[0], told_[1], fastest_ - braked});
    told_ = {commanded, told_[0]};
    const Mismatch found = compare(commanded, measured, duty);
    const bool followsPush = std::abs(duty) >= pushing && commanded * measured > 0 &&
                             std::abs(measured) >= std::abs(commanded) / 2;
    const bool follows =
        followsPush || (std::abs(commanded) >= settings_.commanded && std::abs(measured) >= settings_.moving);
    const double share = found != Mismatch::None ? 1 : follows ? -1 : -forgetting;
    unexplained_s_ = std::max(0.0, unexplained_s_ + share * step);
    return unexplained_s_ >= settings_.hold_s ? found : Mismatch::None;
}

const char *toText(EncoderMonitor::Mismatch mismatch) {
    switch (mismatch) {
    case EncoderMonitor::Mismatch::StandsStill:
        return "was told to turn and stands still";
    case EncoderMonitor::Mismatch::MovesUncommanded:
        return "turns although it was told to stop";
    case EncoderMonitor::Mismatch::MovesBackwards:
        return "turns against its command";
    case EncoderMonitor::Mismatch::MovesTooFast:
        return "turns far faster than its command";
    case EncoderMonitor::Mismatch::None:
        break;
    }
    return "follows its command";
}

} // namespace hermes::motorcontrol
