#pragma once

#include "vectorlib/graph/PoseConstraint.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace vectorlib {

/// Settings of LoopAgreement: when two loops tell the same. A way is that of the drive.
struct LoopAgreementSettings {
    double within = 30;                    ///< way on which loops are asked, at both of their ends; metres
    double along = 15;                     ///< least way on which they agree; metres
    double apart = 1;                      ///< least way between two that count; metres
    double missXY = 0.3, missAlpha = 0.06; ///< by how much two may miss each other; metres, radians
    double missPart = 0.03;                ///< and by so much of the ways between them
};

/// Loops that are not believed before others, found on the same stretch of the drive, tell the same.
class LoopAgreement {
public:
    LoopAgreementSettings settings;

    /// An end of a loop, as the drive alone led there.
    struct End {
        Transformation2D pose;
        double way; ///< since the start of the drive; metres
    };
    /// A loop that waits for others, and its two ends.
    struct Waiting {
        PoseConstraint loop;
        End from, to;
    };

    /// Takes the next loop. Where it and those that agree with it are at least `enough` they are given, and
    /// forgotten; else nothing is.
    std::vector<PoseConstraint> add(const PoseConstraint &loop, const End &from, const End &to,
                                    std::size_t enough) {
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
        waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(),
                                      [&](const Waiting &w) { return agree(w, next); }),
                       waiting_.end());
        return agreed;
    }
    /// The last one that waits, where the drive went on for no more than `within` since.
    std::optional<Waiting> newest(double way) const {
        const bool isAny = !waiting_.empty() && way - waiting_.back().to.way <= settings.within;
        return isAny ? std::optional(waiting_.back()) : std::nullopt;
    }
    void clear() { waiting_.clear(); }

private:
    // Whether both lead from the first one's begin to the second one's end alike.
    bool agree(const Waiting &a, const Waiting &b) const {
        const double fromWay = std::abs(b.from.way - a.from.way), toWay = std::abs(b.to.way - a.to.way);
        if (fromWay > settings.within)
            return false;
        const Transformation2D one = a.loop.motion * (a.to.pose.inverse() * b.to.pose);
        const Transformation2D other = (a.from.pose.inverse() * b.from.pose) * b.loop.motion;
        const Transformation2D off = one.inverse() * other;
        return off.translation().norm() <= settings.missXY + settings.missPart * (fromWay + toWay) &&
               std::abs(off.alpha()) <= settings.missAlpha;
    }

    std::vector<Waiting> waiting_;
};

} // namespace vectorlib
