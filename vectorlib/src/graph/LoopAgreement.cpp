#include "vectorlib/graph/LoopAgreement.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY std::vector<PoseConstraint> LoopAgreement::add(const PoseConstraint &loop, const End &from,
                                                              const End &to, std::size_t enough) {
    const auto isOver = [&](const Waiting &w) { return to.way - w.to.way > settings.within; };
    waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), isOver), waiting_.end());
    const Waiting next{loop, from, to};
    waiting_.push_back(next);
    std::size_t count = 0;
    double first = 0, counted = 0; // way to those that agree
    std::vector<PoseConstraint> agreed;
    for (const Waiting &w : waiting_) {
        if (!agree(w, next))
            continue;
        if (count == 0)
            first = w.to.way;
        if (count == 0 || w.to.way - counted >= settings.apart) {
            ++count;
            counted = w.to.way;
        }
        agreed.push_back(w.loop);
    }
    if (count < enough || to.way - first < settings.along)
        return {};
    waiting_.erase(
        std::remove_if(waiting_.begin(), waiting_.end(), [&](const Waiting &w) { return agree(w, next); }),
        waiting_.end());
    return agreed;
}

VECTORLIB_BODY std::optional<LoopAgreement::Waiting> LoopAgreement::newest(double way) const {
    const bool isAny = !waiting_.empty() && way - waiting_.back().to.way <= settings.within;
    return isAny ? std::optional(waiting_.back()) : std::nullopt;
}

VECTORLIB_BODY bool LoopAgreement::agree(const Waiting &a, const Waiting &b) const {
    const double fromWay = std::abs(b.from.way - a.from.way), toWay = std::abs(b.to.way - a.to.way);
    if (fromWay > settings.within)
        return false;
    const Transformation2D one = a.loop.motion * (a.to.pose.inverse() * b.to.pose);
    const Transformation2D other = (a.from.pose.inverse() * b.from.pose) * b.loop.motion;
    const Transformation2D off = one.inverse() * other;
    return off.translation().norm() <= settings.missXY + settings.missPart * (fromWay + toWay) &&
           std::abs(off.alpha()) <= settings.missAlpha;
}

} // namespace vectorlib
