#include "gui/desktop/view/KeyScanGraph.h"

#include "gui/desktop/view/Plausible.h"

namespace hermes::desktop {

bool KeyScanGraph::take(const GraphMessage &message) {
    if (message.cleared)
        clear();
    else if (isBehind_)
        return true;
    if (message.first < 0 || message.size < 0 || message.first > message.size) {
        ignored_ += 1 + message.poses.size() + message.loops.size();
        return true;
    }
    const bool isNext = message.cleared || double(message.revision) <= revision_ + 1;
    if (!isNext || message.first > (known_.size() < maxKeyScans ? known_.size() : message.size)) {
        isBehind_ = true;
        return false;
    }
    revision_ = double(message.revision);
    size_ = int(qMin<qint64>(message.size, maxKeyScans));
    addPoses(message);
    addLoops(message.loops);
    return true;
}

void KeyScanGraph::clear() {
    known_ = {};
    revision_ = 0;
    size_ = 0;
    isBehind_ = false;
}

// A key scan that lies nowhere stands where the one before it does, for the numbers of those that follow.
void KeyScanGraph::addPoses(const GraphMessage &message) {
    qint64 number = message.first;
    for (std::size_t i = 0; i < message.poses.size(); ++i, ++number) {
        if (number >= maxKeyScans || number >= message.size) {
            ignored_ += message.poses.size() - i;
            return;
        }
        const auto &[x, y, theta] = message.poses[i];
        const Pose2D pose{x, y, theta};
        const double trust = i < message.trust.size() ? message.trust[i] : -1;
        const bool isPlace = isPlausible(pose), isTrust = trust >= 0 && trust <= 1;
        ignored_ += !isPlace + !isTrust;
        if (number == known_.size()) {
            known_.poses.append(number > 0 ? known_.poses.back() : Pose2D());
            known_.trust.append(0);
        }
        if (isPlace)
            known_.poses[int(number)] = pose;
        known_.trust[int(number)] = isPlace && isTrust ? trust : 0;
    }
}

void KeyScanGraph::addLoops(const std::vector<GraphLoop> &loops) {
    const auto isKnown = [this](qint64 number) { return number >= 0 && number < known_.size(); };
    for (const GraphLoop &loop : loops)
        if (isKnown(loop.from) && isKnown(loop.to) && loop.weight >= 0 && loop.weight <= 1 &&
            known_.loops.size() < maxLoops)
            known_.loops.append(loop);
        else
            ++ignored_;
}

} // namespace hermes::desktop
