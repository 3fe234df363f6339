#pragma once

#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/segmentation/EarSegmenter.h"
#include "vectorlib/segmentation/ScanOrder.h"
#include "vectorlib/vectorization/AftlsVectorizer.h"

#include <vector>

namespace vectorlib {

/// Turns a scan into edges: segmentation, then vectorization of every cluster. Thesis 4.2.2. Keeps its
/// buffers between calls.
class EdgeExtractor {
public:
    EarSegmenter<float> segment;
    AftlsVectorizer<float> vectorize;
    ScanOrder order;
    std::size_t minPoints = 4; ///< lines through fewer points are no edges
    double minLength = 0.10;   ///< shorter lines are no edges; metres

    /// The edges of a scan: sensor frame, points in the order of ScanOrder, free space on the left of edges.
    const std::vector<EdgeRaw2D> &operator()(PointSpan<float> given) {
        const PointSpan<float> scan = order(given);
        return vectorizeClusters(segment(scan), scan);
    }

    /// The last step of operator(), for callers that time the steps.
    const std::vector<EdgeRaw2D> &vectorizeClusters(const Segmentation &clusters, PointSpan<float> scan) {
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

private:
    std::vector<Vector2D<float>> cluster_;
    std::vector<EdgeRaw2D> edges_;
};

} // namespace vectorlib
