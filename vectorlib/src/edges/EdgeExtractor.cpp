#include "vectorlib/edges/EdgeExtractor.h"

namespace vectorlib {

VECTORLIB_BODY const std::vector<EdgeRaw2D> &EdgeExtractor::vectorizeClusters(const Segmentation &clusters,
                                                                              PointSpan<float> scan) {
    edges_.clear();
    for (std::size_t c = 0; c < clusters.size(); ++c) {
        cluster_.clear();
        for (std::size_t i = clusters.starts[c]; i < clusters.starts[c + 1]; ++i)
            cluster_.push_back(scan[static_cast<std::size_t>(clusters.order[i])]);
        for (const VectorizedLine &line : vectorize(cluster_))
            if (line.line.isValid() && line.last - line.first + 1 >= minPoints &&
                line.segment.length() >= minLength)
                edges_.emplace_back(line.sums, line.segment, line.sigma);
    }
    return edges_;
}

} // namespace vectorlib
