#pragma once

#include "vectorlib/vectorization/BlockSearch.h"
#include "vectorlib/vectorization/LongestIntervals.h"
#include "vectorlib/vectorization/MakeLines.h"
#include "vectorlib/vectorization/Polyline.h"
#include "vectorlib/vectorization/PrefixSums.h"
#include "vectorlib/vectorization/VectorizedLine.h"

#include <type_traits>
#include <vector>

namespace vectorlib {

/// One total least squares line through the whole cluster, whatever its shape. Thesis 4.2.2, 6.2.2.
/// Fewer than two points give no line. The points must be finite.
template <typename Scalar = float>
class TlsVectorizer {
public:
    VectorizerSettings settings;

    /// The lines of one cluster, in the frame of its points; metres. Valid until the next call.
    const std::vector<VectorizedLine> &operator()(PointSpan<Scalar> points) {
        lines_.clear();
        if (points.size() >= 2)
            lines_.push_back(
                makeLine(points, 0, points.size() - 1, TlsSums::of(points.begin(), points.end())));
        return lines_;
    }

private:
    std::vector<VectorizedLine> lines_;
};

/// The search of FTLS: on sums of blocks for points in float.
template <typename Scalar>
using FtlsIntervals =
    LongestIntervals<std::conditional_t<std::is_same_v<Scalar, float>, BlockSearch, PrefixSearch<Scalar>>>;

/// Fast total least squares vectorization: the longest intervals of points within sigma of their line; thesis
/// 6.3. The points are one continuous cluster in scanning order, all finite. Fewer than two points give no
/// line. Every point belongs to exactly one line; every line has at least two points. Keeps its buffers
/// between calls.
template <typename Scalar = float>
class FtlsVectorizer {
public:
    VectorizerSettings settings;
    simd::Level level = simd::bestLevel(); ///< the instruction set to use

    /// The lines of one cluster, in the frame of its points; metres. Valid until the next call.
    const std::vector<VectorizedLine> &operator()(PointSpan<Scalar> points) {
        if (points.size() < 2) {
            lines_.clear();
            return lines_;
        }
        const double variance = settings.variance();
        intervals_.search.level = level;
        const std::vector<Cut> &cuts = intervals_(points, variance);
        makeLines(points, intervals_.search.sums(), cuts, level, lines_);
        if constexpr (std::is_same_v<Scalar, float>)
            if (!checkSigma(cuts))
                makeLines(points, Vector2D<double>(points.front()), exact_(points, variance), lines_);
        if (settings.polyline)
            join_(points, intervals_.search.sums(), settings, lines_);
        return lines_;
    }

    /// The search, with the sums of the last cluster.
    const FtlsIntervals<Scalar> &intervals() const { return intervals_; }

private:
    // False when exact sums say of a line near sigma that it does not fit.
    bool checkSigma(const std::vector<Cut> &cuts) {
        for (std::size_t i = 0; i < lines_.size(); ++i)
            if (lines_[i].sigma > 0.98 * settings.sigma && !intervals_.search.fits(cuts[i], cuts[i + 1]))
                return false;
        return true;
    }

    FtlsIntervals<Scalar> intervals_;
    LongestIntervals<PrefixSearch<Scalar>> exact_;
    std::vector<VectorizedLine> lines_;
    PolylineJoiner join_;
};

} // namespace vectorlib
