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
    Search search = Search::Descent;
    BreakPointDescent descent;
    BreakPointSimplex simplex;

    const std::vector<VectorizedLine> &operator()(PointSpan<Scalar> points) {
        ftls_.settings = settings;
        ftls_.settings.sigma = std::max(0.0, settings.sigma);
        ftls_.settings.polyline = false;
        lines_ = ftls_(points); // into the same memory
        if (lines_.size() > 1 && areFinite()) {
            if (search == Search::Descent)
                descent(points, lines_);
            else
                runSimplex(points);
            for (VectorizedLine &line : lines_)
                line = makeLine(points, line.first, line.last, line.sums);
        }
        if (settings.polyline)
            join_(points, ftls_.sums(), settings, lines_);
        return lines_;
    }

private:
    bool areFinite() const {
        for (const VectorizedLine &line : lines_)
            if (line.sums.n == 0)
                return false;
        return true;
    }
    void runSimplex(PointSpan<Scalar> points) {
        prefix_.assign(points);
        cuts_.assign(1, 0);
        for (const VectorizedLine &line : lines_)
            cuts_.push_back(line.last + 1);
        simplex(prefix_, cuts_);
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            lines_[i].first = cuts_[i];
            lines_[i].last = cuts_[i + 1] - 1;
            lines_[i].sums = prefix_.sums(cuts_[i], cuts_[i + 1]);
        }
    }

    FtlsVectorizer<Scalar> ftls_;
    std::vector<VectorizedLine> lines_;
    PrefixSums prefix_; // for the simplex only
    std::vector<std::size_t> cuts_;
    PolylineJoiner join_;
};

} // namespace vectorlib
