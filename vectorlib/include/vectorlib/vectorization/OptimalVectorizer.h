#pragma once

#include "vectorlib/vectorization/Polyline.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace vectorlib {

/// The break points with the least error E (thesis 6.27) for a given number of lines, by dynamic programming:
/// exact, and slow, O(L N^2). It tells how near others come. The points must be finite; fewer than two give
/// no line; every line has at least two points. Keeps its buffers between calls.
template <typename Scalar = float>
class OptimalVectorizer {
public:
    VectorizerSettings settings; ///< sigma is not used
    std::size_t lines = 1;       ///< how many; fewer where there are fewer than two points for each

    /// The lines of one cluster, in the frame of its points; metres. Valid until the next call.
    const std::vector<VectorizedLine> &operator()(PointSpan<Scalar> points) {
        lines_.clear();
        const std::size_t count = points.size();
        if (count < 2)
            return lines_;
        sums_.assign(points);
        const std::size_t wanted = std::clamp<std::size_t>(lines, 1, count / 2);
        fillTable(count, wanted);
        cuts_.assign(wanted + 1, count);
        for (std::size_t l = wanted; l > 1; --l)
            cuts_[l - 1] = from_[cuts_[l] * wanted + l - 1];
        cuts_[0] = 0;
        for (std::size_t l = 0; l < wanted; ++l)
            lines_.push_back(
                makeLine(points, cuts_[l], cuts_[l + 1] - 1, sums_.sums(cuts_[l], cuts_[l + 1])));
        error_ = least_[count * wanted + wanted - 1] / static_cast<double>(count);
        if (settings.polyline)
            join_(points, sums_, settings, lines_);
        return lines_;
    }

    /// E of the last cluster before joining; m^2. Thesis (6.27).
    double error() const { return error_; }

private:
    // least_[end * wanted + l] is the least sum of squares of points 0 .. end - 1 on l + 1 lines, and from_
    // says where the last of these lines begins.
    void fillTable(std::size_t count, std::size_t wanted) {
        const double none = std::numeric_limits<double>::infinity();
        least_.assign((count + 1) * wanted, none);
        from_.assign((count + 1) * wanted, 0);
        for (std::size_t end = 2; end <= count; ++end) {
            double *least = &least_[end * wanted];
            std::size_t *from = &from_[end * wanted];
            least[0] = sumOfSquares(sums_.sums(0, end));
            for (std::size_t first = 2; first + 2 <= end; ++first) {
                const double squares = sumOfSquares(sums_.sums(first, end));
                const double *before = &least_[first * wanted];
                for (std::size_t l = 1; l < wanted; ++l) {
                    const double total = before[l - 1] + squares;
                    from[l] = total < least[l] ? first : from[l];
                    least[l] = total < least[l] ? total : least[l];
                }
            }
        }
    }

    PrefixSums sums_;
    std::vector<double> least_;
    std::vector<std::size_t> from_;
    std::vector<std::size_t> cuts_;
    double error_ = 0;
    std::vector<VectorizedLine> lines_;
    PolylineJoiner join_;
};

} // namespace vectorlib
