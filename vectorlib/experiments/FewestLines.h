#pragma once

#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/tls/TlsFit.h"
#include "vectorlib/vectorization/PrefixSums.h"

#include <vector>

namespace hermes::experiments {

/// The fewest intervals into which a cluster can be cut so that the points of each lie within sigma (metres)
/// of a line; a single point does. By dynamic programming: exact, and slow, O(N^2). It is what extractors are
/// compared with where nobody counted the lines: a lower bound for those that keep sigma. 0 without points,
/// which must be finite.
template <typename Scalar>
std::size_t fewestLines(vectorlib::PointSpan<Scalar> points, double sigma) {
    vectorlib::PrefixSums sums;
    sums.assign(points);
    std::vector<std::size_t> fewest(points.size() + 1, 0); // of the points before
    for (std::size_t end = 1; end <= points.size(); ++end) {
        fewest[end] = fewest[end - 1] + 1;
        for (std::size_t first = 0; first + 1 < end; ++first)
            if (fewest[first] + 1 < fewest[end] && vectorlib::fitsWithin(sums.sums(first, end), sigma))
                fewest[end] = fewest[first] + 1;
    }
    return fewest.back();
}

} // namespace hermes::experiments
