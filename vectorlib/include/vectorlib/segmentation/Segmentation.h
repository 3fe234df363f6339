#pragma once

#include <cstddef>
#include <vector>

namespace vectorlib {

/// What a segmentation found; indices are those of the points given.
struct Segmentation {
    std::vector<int> labels; ///< the cluster of each point, -1 for an outlier
    std::vector<int> order;  ///< the points of all clusters, cluster after cluster, each in scanning order
    std::vector<std::size_t> starts; ///< cluster c holds order[starts[c]] .. order[starts[c + 1] - 1]

    /// The number of clusters.
    std::size_t size() const { return starts.empty() ? 0 : starts.size() - 1; }
    /// The number of points of a cluster.
    std::size_t size(std::size_t cluster) const { return starts[cluster + 1] - starts[cluster]; }
};

} // namespace vectorlib
