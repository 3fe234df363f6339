#pragma once

#include "vectorlib/vectorization/BreakPointDescent.h"
#include "vectorlib/vectorization/BreakPointSimplex.h"
#include "vectorlib/vectorization/FtlsVectorizer.h"

#include <vector>

namespace vectorlib {

/// FTLS whose break points are moved to where the error E (thesis 6.27) of the whole cluster is least;
/// thesis 6.4. As many lines as FTLS finds, E never above that of FTLS; a single line may exceed sigma. The
/// points are one continuous cluster in scanning order. Fewer than two points give no line. Every point
/// belongs to exactly one line; every line has at least two points. A point that is not finite leaves invalid
/// lines. Keeps its buffers between calls.
template <typename Scalar = float>
class AftlsVectorizer {
public:
    /// How the least error is sought. Descent comes nearer to the optimum in a fraction of the time
    /// (docs/algorithms.md); NelderMead is what is published.
    enum class Search { Descent, NelderMead };

    VectorizerSettings settings;
    simd::Level level = simd::bestLevel(); ///< the instruction set to use
    Search search = Search::Descent;
    BreakPointDescent descent;
    BreakPointSimplex simplex;

    /// The lines of one cluster, in the frame of its points; metres. Valid until the next call.
    const std::vector<VectorizedLine> &operator()(PointSpan<Scalar> points) {
        if (points.size() < 2) {
            lines_.clear();
            return lines_;
        }
        intervals_.search.level = level;
        cuts_ = intervals_(points, settings.variance()); // into the same memory
        if (cuts_.size() > 2) {
            if (search == Search::Descent)
                descent(points, intervals_.search.sums(), level, cuts_);
            else
                runSimplex(points);
        }
        makeLines(points, intervals_.search.sums(), cuts_, level, lines_);
        if (settings.polyline)
            join_(points, intervals_.search.sums(), settings, lines_);
        return lines_;
    }

private:
    void runSimplex(PointSpan<Scalar> points) {
        prefix_.assign(points);
        places_.clear();
        for (const Cut &cut : cuts_)
            places_.push_back(cut.index);
        const double before = squares(places_);
        simplex(prefix_, places_);
        if (squares(places_) < before)
            for (std::size_t i = 0; i < cuts_.size(); ++i)
                cuts_[i] = {places_[i], prefix_.row(places_[i])};
    }
    double squares(const std::vector<std::size_t> &places) const {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < places.size(); ++i)
            sum += sumOfSquares(prefix_.sums(places[i], places[i + 1]));
        return sum;
    }

    FtlsIntervals<Scalar> intervals_;
    std::vector<Cut> cuts_;
    std::vector<VectorizedLine> lines_;
    PrefixSums prefix_; // for the simplex only
    std::vector<std::size_t> places_;
    PolylineJoiner join_;
};

} // namespace vectorlib
