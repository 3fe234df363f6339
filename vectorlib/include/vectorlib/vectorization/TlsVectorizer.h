#pragma once

#include "vectorlib/vectorization/VectorizedLine.h"

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

} // namespace vectorlib
