#pragma once

#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/vectorization/BreakPointErrors.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// Cuts a cluster of points into the longest intervals within a variance of their line (thesis 6.3.2), from
/// both ends, so that reversed points give reversed intervals. No cut into intervals that fit needs fewer of
/// them, as long as parts of what fits fit too. Every interval has two points, and fits, unless three points
/// that do not fit are left. `Search` is PrefixSearch or BlockSearch.
template <typename Search>
class LongestIntervals {
public:
    Search search;

    /// The cuts between the intervals, the begin and the end included. At least two points.
    template <typename Scalar>
    const std::vector<Cut> &operator()(PointSpan<Scalar> points, double variance) {
        search.assign(points, variance);
        cuts_.assign(1, search.at(0));
        tail_.assign(1, search.at(points.size()));
        while (!search.fits(cuts_.back(), tail_.back()) && cut()) {
        }
        if (tail_.back().index - cuts_.back().index == 1)
            giveSinglePoint();
        cuts_.insert(cuts_.end(), tail_.rbegin(), tail_.rend());
        return cuts_;
    }

private:
    // Cuts off an interval at one or both ends. False when nothing is left between them.
    bool cut() {
        cuts_.emplace_back();
        tail_.emplace_back();
        const Cut &first = cuts_.end()[-2], &end = tail_.end()[-2];
        Cut &ahead = cuts_.back(), &back = tail_.back();
        search.findEnds(first, end, ahead, back);
        if (back.index > ahead.index)
            return true;
        if (ahead.index >= end.index) {
            ahead = shorter(first, end);
            tail_.pop_back();
            return true;
        }
        const bool isOne = end.index - first.index < 4, isTwo = !isOne && meet(first, back, end, ahead);
        const bool keepsAhead =
            back.index <= first.index || ahead.index - first.index >= end.index - back.index;
        if (isOne || isTwo || keepsAhead)
            tail_.pop_back();
        if (isOne || !(isTwo || keepsAhead))
            cuts_.pop_back();
        return !isOne && !isTwo;
    }
    // Two intervals are left, which may meet anywhere from `back` to `ahead`: half way, where both fit. False
    // when they do not: a part of an interval need not fit. Moves `ahead` there.
    bool meet(const Cut &first, const Cut &back, const Cut &end, Cut &ahead) {
        const std::size_t low = std::max(back.index, first.index + 2),
                          high = std::min(ahead.index, end.index - 2);
        const Cut a = search.sums().moved(ahead, (low + high) / 2),
                  b = (low + high) % 2 == 0 ? a : search.sums().moved(a, a.index + 1);
        return meetAt(first, a, b, end, ahead) || meetAt(first, search.at(low), search.at(high), end, ahead);
    }
    // At a or b, where less error is left, if both intervals fit.
    bool meetAt(const Cut &first, const Cut &a, const Cut &b, const Cut &end, Cut &ahead) {
        const auto error = [&](const Cut &cut) { return squares(first, cut) + squares(cut, end); };
        const Cut &cut = a.index == b.index || error(a) <= error(b) ? a : b;
        if (!search.fits(first, cut) || !search.fits(cut, end))
            return false;
        ahead = cut;
        return true;
    }
    // The end of an interval from `first` that fits, before `end`.
    Cut shorter(const Cut &first, const Cut &end) const {
        std::size_t index = end.index - 1;
        while (index > first.index + 2 && !search.fits(first, search.at(index)))
            --index;
        return search.at(index);
    }
    // A single point between the intervals from both ends has no line: it takes a point from a neighbour that
    // still fits, or joins it.
    void giveSinglePoint() {
        const Cut first = cuts_.back(), end = tail_.back();
        const bool hasLeft = cuts_.size() > 1, hasRight = tail_.size() > 1;
        const Cut left = hasLeft ? cuts_[cuts_.size() - 2] : first,
                  right = hasRight ? tail_[tail_.size() - 2] : end;
        const bool leftGives = first.index - left.index > 2, rightGives = right.index - end.index > 2;
        const Cut less = leftGives ? search.at(first.index - 1) : first;
        const Cut more = rightGives ? search.at(end.index + 1) : end;
        const bool leftFits = leftGives && search.fits(left, less),
                   rightFits = rightGives && search.fits(more, right);
        // The neighbour that scatters more.
        const bool leftIsWorse = leftGives && (!rightGives || squares(left, first) > squares(end, right));
        if (leftFits && (leftIsWorse || !rightFits))
            cuts_.back() = less;
        else if (rightFits)
            tail_.back() = more;
        else if (hasLeft) {
            cuts_.pop_back();
            cutAgain(left, end);
        } else if (hasRight) {
            tail_.pop_back();
            cutAgain(first, right);
        }
    }
    // An interval of points that do not fit as a whole, into as long ones as fit; of those that leave a rest
    // that fits, the longest.
    void cutAgain(Cut first, const Cut &end) {
        while (end.index - first.index > 3 && !search.fits(first, end)) {
            std::size_t longest = 0, index = end.index - 2;
            for (; index > first.index + 2; --index) {
                const Cut cut = search.at(index);
                if (!search.fits(first, cut))
                    continue;
                longest = std::max(longest, index);
                if (search.fits(cut, end))
                    break;
            }
            const bool isRestLeft = index == first.index + 2 && !search.fits(search.at(index), end);
            first = search.at(isRestLeft && longest > 0 ? longest : index);
            cuts_.push_back(first);
        }
    }
    static double squares(const Cut &first, const Cut &end) {
        return sumOfSquares(double(end.index - first.index), end.row - first.row);
    }

    std::vector<Cut> cuts_, tail_;
};

} // namespace vectorlib
