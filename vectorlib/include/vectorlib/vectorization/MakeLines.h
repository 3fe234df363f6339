#pragma once

#include "vectorlib/vectorization/BlockSums.h"
#include "vectorlib/vectorization/MakeLinesAvx2.h"
#include "vectorlib/vectorization/PrefixSums.h"

#include <vector>

namespace vectorlib {

/// makeLine() for the intervals between cuts, whose rows are in the frame of `origin`.
template <typename Scalar>
void makeLines(PointSpan<Scalar> points, Vector2D<double> origin, const std::vector<Cut> &cuts,
               std::vector<VectorizedLine> &lines) {
    lines.resize(cuts.size() - 1);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const Cut &first = cuts[i], &end = cuts[i + 1];
        lines[i] = makeLine(points, first.index, end.index - 1, sumsBetween(first, end, origin));
    }
}

#if defined(VECTORLIB_SIMD_AVX2)
/// Its twin, four lines at a time.
VECTORLIB_AVX2 inline void makeLinesAvx2(PointSpan<float> points, Vector2D<double> origin,
                                         const std::vector<Cut> &cuts, std::vector<VectorizedLine> &lines) {
    lines.resize(cuts.size() - 1);
    for (std::size_t i = 0; i < lines.size(); i += 4)
        makeFourLinesAvx2(points, origin, &cuts[i], std::min<std::size_t>(lines.size() - i, 4), &lines[i]);
}
#endif

/// The same from sums in double, and from sums in float with the instruction set to use.
template <typename Scalar>
void makeLines(PointSpan<Scalar> points, const PrefixSums &sums, const std::vector<Cut> &cuts, simd::Level,
               std::vector<VectorizedLine> &lines) {
    makeLines(points, sums.origin(), cuts, lines);
}
/// The same from sums in float; lines for which these are not exact enough are made from exact sums.
inline void makeLines(PointSpan<float> points, const BlockSums &sums, const std::vector<Cut> &cuts,
                      [[maybe_unused]] simd::Level level, std::vector<VectorizedLine> &lines) {
#if defined(VECTORLIB_SIMD_AVX2)
    if (level == simd::Level::Avx2)
        makeLinesAvx2(points, sums.origin(), cuts, lines);
    else
#endif
        makeLines(points, sums.origin(), cuts, lines);
    // A point far from the others of its block spoils the float sums of the block: exact ones tell.
    for (VectorizedLine &line : lines) {
        const double error = sums.localError(line.first, line.last + 1);
        if (!(error <= 0.2 * line.sigma * line.sigma * line.sums.n) && error > 1e-12)
            line = makeLine(points, line.first, line.last, sums.exactSums(line.first, line.last + 1));
    }
}

} // namespace vectorlib
