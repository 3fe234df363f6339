#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/segmentation/ClusterOrder.h"
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
    const std::vector<EdgeRaw2D> &vectorizeClusters(const Segmentation &clusters, PointSpan<float> scan);

private:
    std::vector<Vector2D<float>> cluster_;
    std::vector<EdgeRaw2D> edges_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/edges/EdgeExtractor.cpp")
