#pragma once

#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/vectorization/BreakPointErrors.h"

#include <Eigen/Core>

#include <algorithm>
#include <vector>

namespace vectorlib {

/// Moves the break points between the lines of one cluster, one at a time, while the error E (thesis 6.27)
/// falls. A move changes the two lines beside the break point only, whose sums follow from the rows of three
/// cuts: no point is touched but those near a break point. Every line keeps at least two points (erratum 4).
/// E never grows.
class BreakPointDescent {
public:
    int rounds = 2; ///< over all break points, at most

    /// Cuts of the points, the first and the last included, with rows as `sums` (PrefixSums or BlockSums) has
    /// them.
    template <typename Scalar, typename Sums>
    void operator()(PointSpan<Scalar> points, const Sums &sums, simd::Level level, std::vector<Cut> &cuts) {
        moved_.assign(cuts.size(), 1); // moved_[i]: cut i, when last looked at
        moved_.front() = moved_.back() = 0;
        for (int round = 0; round < rounds; ++round) {
            bool any = false;
            for (std::size_t i = 1; i + 1 < cuts.size(); ++i) {
                // Only what changed beside a cut can move it again.
                if (round > 0 && !moved_[i - 1] && !moved_[i + 1])
                    continue;
                const std::size_t before = cuts[i].index;
                const std::size_t smaller = std::min(before - cuts[i - 1].index, cuts[i + 1].index - before);
                improve(points, sums, level, &cuts[i],
                        round == 0 ? std::max<std::size_t>(smaller / 40, 4) : 1);
                const std::size_t now = cuts[i].index, move = std::max(before, now) - std::min(before, now);
                moved_[i] = move * 3 > smaller; // less hardly turns a line
                any = any || moved_[i];
            }
            if (!any)
                return;
        }
    }

private:
    // Looks at three places on both sides, `stride` points apart, goes to the best, and again with a smaller
    // stride.
    template <typename Scalar, typename Sums>
    static void improve(PointSpan<Scalar> points, const Sums &sums, simd::Level level, Cut *cut,
                        std::size_t stride) {
        constexpr int reach = 3;
        const std::size_t lowest = cut[-1].index + 2, highest = cut[1].index - 2;
        if (lowest > highest)
            return;
        const Vector2D<double> origin = sums.origin();
        for (;;) {
            // The middle is the first place, so that it wins where nothing is better.
            Cut places[8];
            places[0] = *cut;
            for (int i = 1; i <= reach; ++i) {
                const std::size_t back = static_cast<std::size_t>(i) * stride;
                const std::size_t low =
                    cut->index >= lowest + back ? cut->index - back : std::min(lowest, cut->index);
                const std::size_t high = std::max(cut->index, std::min(cut->index + back, highest));
                places[i] = moved(points, sums, origin, i == 1 ? *cut : places[i - 1], low);
                places[reach + i] = moved(points, sums, origin, i == 1 ? *cut : places[reach + i - 1], high);
            }
            places[7] = *cut;
            const std::size_t best = bestPlace(cut[-1], cut[1], places, level);
            *cut = places[best];
            if (best == reach || best == 2 * reach)
                continue; // the best is at the border of what was looked at
            if (stride == 1)
                return;
            stride = std::max<std::size_t>(stride / 6, 1);
        }
    }
    // The same cut at another place.
    template <typename Scalar, typename Sums>
    static Cut moved(PointSpan<Scalar> points, const Sums &sums, Vector2D<double> origin, Cut cut,
                     std::size_t to) {
        const std::size_t far = to > cut.index ? to - cut.index : cut.index - to;
        if (sums.stride() == 1 || far > sums.stride() / 2)
            return {to, sums.row(to)};
        using Pair = Eigen::Array2d;
        const Pair shift(origin.x, origin.y);
        Pair sums1 = Pair::Zero(), squares = sums1;
        double products = 0;
        for (std::size_t i = std::min(to, cut.index); i < std::max(to, cut.index); ++i) {
            const Pair p = Pair(points[i].x, points[i].y) - shift;
            sums1 += p;
            squares += p * p;
            products += p.x() * p.y();
        }
        const SumRow between{sums1.x(), sums1.y(), squares.x(), squares.y(), products};
        return {to, to > cut.index ? cut.row + between : cut.row - between};
    }

    std::vector<char> moved_;
};

} // namespace vectorlib
