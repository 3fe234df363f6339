#pragma once

#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/vectorization/BreakPointErrors.h"
#include "vectorlib/vectorization/BreakPointStepAvx2.h"

#include <algorithm>
#include <type_traits>
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
    void operator()([[maybe_unused]] PointSpan<Scalar> points, const Sums &sums, simd::Level level,
                    std::vector<Cut> &cuts) {
        states_.resize(cuts.size());
        for (std::size_t i = 1; i + 1 < cuts.size(); ++i)
            states_[i] = begin(&cuts[i], 0);
        states_.front().moved = states_.back().moved = false;
        stepAll<4>(points, sums, level, cuts);
        stepAll<1>(points, sums, level, cuts);
        for (int round = 0; round < rounds; ++round) {
            bool any = false;
            for (std::size_t i = 1; i + 1 < cuts.size(); ++i) {
                // Only what changed beside a cut can move it again.
                if (round > 0 && !states_[i - 1].moved && !states_[i + 1].moved)
                    continue;
                State &state = states_[i];
                if (round > 0)
                    state = begin(&cuts[i], 1);
                if (state.stride > 0)
                    improve(sums, level, &cuts[i], state.stride);
                const std::size_t now = cuts[i].index;
                const std::size_t move = std::max(state.index, now) - std::min(state.index, now);
                state.moved = move * 3 > state.room; // less hardly turns a line
                any = any || state.moved;
            }
            if (!any)
                return;
        }
    }

private:
    // A cut when last looked at.
    struct State {
        std::size_t index;
        std::size_t room;   // points of the shorter line beside it
        std::size_t stride; // where it is to be looked at, 0: settled
        bool moved;
    };

    static std::size_t room(const Cut *cut) {
        return std::min(cut->index - cut[-1].index, cut[1].index - cut->index);
    }
    // stride 0: the first one.
    static State begin(const Cut *cut, std::size_t stride) {
        const std::size_t r = room(cut);
        return {cut->index, r, stride > 0 ? stride : r < 320 ? 4 : r / 40, true};
    }
    static std::size_t smaller(std::size_t stride) {
        return stride >= 48 ? stride / 6 : stride > 4 ? 4 : stride == 4;
    }

    // One step of every cut that looks at this stride and has room: every second one, two at a time, and then
    // the others.
    template <int stride, typename Scalar, typename Sums>
    void stepAll([[maybe_unused]] PointSpan<Scalar> points, const Sums &sums, simd::Level level,
                 std::vector<Cut> &cuts) {
        const auto steps = [&](std::size_t i) {
            return i + 1 < cuts.size() && states_[i].stride == stride && room(&cuts[i]) > 4 * stride;
        };
        const auto settle = [&](std::size_t i, bool isSettled) {
            if (isSettled)
                states_[i].stride = smaller(stride);
        };
        for (const std::size_t first : {1, 2})
            for (std::size_t i = first; i + 1 < cuts.size(); i += 4) {
#if defined(VECTORLIB_SIMD_AVX2)
                if constexpr (std::is_same_v<Scalar, float>)
                    if (level == simd::Level::Avx2 && steps(i) && steps(i + 2)) {
                        const auto [a, b] = stepAvx2<stride>(points, sums.origin(), &cuts[i], &cuts[i + 2]);
                        settle(i, a);
                        settle(i + 2, b);
                        continue;
                    }
#endif
                for (const std::size_t k : {i, i + 2})
                    if (steps(k))
                        settle(k, stepOne<stride>(points, sums, level, &cuts[k]));
            }
    }
    template <int stride, typename Scalar, typename Sums>
    static bool stepOne([[maybe_unused]] PointSpan<Scalar> points, const Sums &sums, simd::Level level,
                        Cut *cut) {
#if defined(VECTORLIB_SIMD_AVX2)
        if constexpr (std::is_same_v<Scalar, float>)
            if (level == simd::Level::Avx2)
                return stepAvx2<stride>(points, sums.origin(), cut);
#endif
        return step(sums, level, cut, stride);
    }
    // Steps with smaller and smaller strides.
    template <typename Sums>
    static void improve(const Sums &sums, simd::Level level, Cut *cut, std::size_t stride) {
        if (cut[-1].index + 4 > cut[1].index)
            return;
        while (stride > 0)
            if (step(sums, level, cut, stride))
                stride = smaller(stride);
    }
    // Looks at three places on both sides, `stride` points apart, and goes to the best. False when that is at
    // the border of what was looked at.
    template <typename Sums>
    static bool step(const Sums &sums, simd::Level level, Cut *cut, std::size_t stride) {
        constexpr int reach = 3;
        const std::size_t lowest = cut[-1].index + 2, highest = cut[1].index - 2;
        // The middle is the first place, so that it wins where nothing is better.
        Cut places[8];
        places[0] = *cut;
        for (int i = 1; i <= reach; ++i) {
            const std::size_t back = static_cast<std::size_t>(i) * stride;
            const std::size_t low =
                cut->index >= lowest + back ? cut->index - back : std::min(lowest, cut->index);
            const std::size_t high = std::max(cut->index, std::min(cut->index + back, highest));
            places[i] = sums.moved(i == 1 ? *cut : places[i - 1], low);
            places[reach + i] = sums.moved(i == 1 ? *cut : places[reach + i - 1], high);
        }
        places[7] = *cut;
        const std::size_t best = bestPlace(cut[-1], cut[1], places, level);
        *cut = places[best];
        return best != reach && best != 2 * reach;
    }

    std::vector<State> states_;
};

} // namespace vectorlib
