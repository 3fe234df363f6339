#pragma once

#include "vectorlib/mapping/Edge2D.h"
#include "vectorlib/segmentation/EarSegmenter.h"
#include "vectorlib/vectorization/AftlsVectorizer.h"

#include <vector>

namespace vectorlib {

/// One scan and what was made of it. Thesis 4.2.2.
struct Observation2D {
    std::vector<Vector2D<float>> cloud; ///< sensor frame, counter-clockwise; metres
    Pose2D expectedPose;                ///< of the sensor, before matching
    double stamp = 0;                   ///< seconds since the Unix epoch
    std::vector<EdgeRich2D> edges;      ///< sensor frame
    std::vector<int> outliers;          ///< indices into cloud of the points that belong to no edge
};

/// Turns a scan into edges: segmentation, then vectorization of every cluster. Keeps its buffers between
/// calls.
class EdgeExtractor {
public:
    EarSegmenter<float> segment;
    AftlsVectorizer<float> vectorize;
    std::size_t minPoints = 4; ///< lines through fewer points are no edges
    double minLength = 0.10;   ///< shorter lines are no edges; metres

    /// The edges of a scan (sensor frame, points in order of acquisition), without links to rich edges.
    const std::vector<EdgeRaw2D> &operator()(PointSpan<float> scan) {
        edges_.clear();
        forEachLine(segment(scan), scan,
                    [this](const VectorizedLine &l) { edges_.emplace_back(l.sums, l.segment, l.sigma); });
        return edges_;
    }

    /// The second half of operator(), for callers that time both halves.
    const std::vector<EdgeRaw2D> &vectorizeClusters(const Segmentation &clusters, PointSpan<float> scan) {
        edges_.clear();
        forEachLine(clusters, scan,
                    [this](const VectorizedLine &l) { edges_.emplace_back(l.sums, l.segment, l.sigma); });
        return edges_;
    }

    /// Fills the edges and outliers of an observation from its cloud. The observation must not move
    /// afterwards: its edges point to it.
    void operator()(Observation2D &observation) {
        observation.edges.clear();
        observation.outliers.clear();
        const PointSpan<float> scan(observation.cloud);
        used_.assign(scan.size(), 0);
        const Segmentation &clusters = segment(scan);
        std::size_t cluster = 0;
        forEachLine(
            clusters, scan,
            [&](const VectorizedLine &l) {
                EdgeRich2D edge;
                edge.points.assign(cluster_.begin() + static_cast<std::ptrdiff_t>(l.first),
                                   cluster_.begin() + static_cast<std::ptrdiff_t>(l.last) + 1);
                for (std::size_t i = l.first; i <= l.last; ++i)
                    used_[static_cast<std::size_t>(clusters.order[clusters.starts[cluster] + i])] = 1;
                edge.sums = l.sums;
                edge.segment = l.segment;
                edge.sigma = l.sigma;
                edge.observation = &observation;
                observation.edges.push_back(std::move(edge));
            },
            &cluster);
        for (std::size_t i = 0; i < used_.size(); ++i)
            if (!used_[i])
                observation.outliers.push_back(static_cast<int>(i));
    }

private:
    template <typename Take>
    void forEachLine(const Segmentation &clusters, PointSpan<float> scan, Take take,
                     std::size_t *index = nullptr) {
        for (std::size_t c = 0; c < clusters.size(); ++c) {
            cluster_.clear();
            for (std::size_t i = clusters.starts[c]; i < clusters.starts[c + 1]; ++i)
                cluster_.push_back(scan[static_cast<std::size_t>(clusters.order[i])]);
            if (index)
                *index = c;
            for (const VectorizedLine &line : vectorize(cluster_))
                if (line.line.isValid() && line.last - line.first + 1 >= minPoints &&
                    line.segment.length() >= minLength)
                    take(line);
        }
    }

    std::vector<Vector2D<float>> cluster_;
    std::vector<char> used_;
    std::vector<EdgeRaw2D> edges_;
};

} // namespace vectorlib
