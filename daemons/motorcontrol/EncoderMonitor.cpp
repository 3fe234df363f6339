#include "daemons/motorcontrol/EncoderMonitor.h"

#include <cmath>

namespace hermes::motorcontrol {

EncoderMonitor::Mismatch EncoderMonitor::compare(double commanded, double measured) const {
    const bool told = std::abs(commanded) >= settings_.commanded;
    const bool moves = !(std::abs(measured) < settings_.moving); // also when it is no number
    if (told && !moves)
        return Mismatch::StandsStill;
    if (told && commanded * measured < 0)
        return Mismatch::MovesBackwards;
    // Also of a slow command: a control of the velocity that runs away, as with an encoder that counts
    // backward.
    if (std::abs(measured - commanded) > std::abs(commanded) + settings_.commanded && commanded != 0)
        return commanded * measured < 0 ? Mismatch::MovesBackwards : Mismatch::MovesTooFast;
    return commanded == 0 && moves ? Mismatch::MovesUncommanded : Mismatch::None;
}

EncoderMonitor::Mismatch EncoderMonitor::judge(double commanded, double measured, double now) {
    const Mismatch found = compare(commanded, measured);
    if (found != lasting_) {
        lasting_ = found;
        since_ = now;
    }
    return now - since_ >= settings_.hold_s ? found : Mismatch::None;
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
