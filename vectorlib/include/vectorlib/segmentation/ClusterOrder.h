#pragma once

#include "vectorlib/segmentation/RunClusters.h"
#include "vectorlib/simd/Lanes.h"

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

/// From clusters of runs to labels and order. Keeps its buffers.
class ClusterOrder {
public:
    /// Numbers the clusters of at least `minPoints` points by their first points.
    void number(const RunClusters &runs, std::size_t minPoints) {
        size_.assign(runs.runs(), 0);
        for (std::size_t run = 0; run < runs.runs(); ++run)
            size_[runs.root(run)] += runs.length(run);
        label_.resize(runs.runs());
        clusters_.clear();
        for (std::size_t run = 0; run < runs.runs(); ++run) {
            const std::size_t root = runs.root(run);
            if (root != run)
                label_[run] = label_[root];
            else if (size_[run] < minPoints)
                label_[run] = -1;
            else {
                label_[run] = static_cast<int>(clusters_.size());
                clusters_.push_back({run, run, size_[run], runs.begin(run), 0});
            }
            if (label_[run] >= 0)
                clusters_[index(label_[run])].lastRun = run;
        }
    }
    /// A cluster that runs over the end of the scan begins after the widest gap between its points.
    template <typename Nearness>
    void startAfterWidestGaps(const RunClusters &runs, const Comparison<Nearness> &points,
                              std::size_t reach) {
        const std::size_t near = std::min(points.count(), reach);
        for (std::size_t c = 0; c < clusters_.size(); ++c)
            if (runs.begin(clusters_[c].firstRun) < near &&
                runs.begin(clusters_[c].lastRun + 1) > points.count() - near)
                startAfterWidestGap(runs, points.nearness, static_cast<int>(c));
    }
    /// Writes the result for `count` points, of which those of `taking` take part; null: all, or none where
    /// there are no runs.
    void write(const RunClusters &runs, const int *taking, std::size_t count, simd::Level level,
               Segmentation &result) {
        result.starts.assign(1, 0);
        for (Cluster &c : clusters_) {
            result.starts.push_back(result.starts.back() + c.size);
            c.next = result.starts.back() - c.before;
        }
        result.order.resize(result.starts.back());
        result.labels.resize(count);
        if (runs.begin(runs.runs()) < count)
            simd::ramp(result.labels.data(), count, -1, 0, level);
        for (std::size_t run = 0; run < runs.runs(); ++run) {
            std::size_t begin = runs.begin(run);
            const std::size_t end = runs.begin(run + 1);
            const int label = label_[run];
            if (!taking)
                simd::ramp(result.labels.data() + begin, end - begin, label, 0, level);
            if (label < 0)
                continue;
            for (std::size_t i = begin; taking && i < end; ++i)
                result.labels[index(taking[i])] = label;
            Cluster &c = clusters_[index(label)];
            const auto append = [&](std::size_t until) {
                int *order = result.order.data() + c.next;
                if (taking)
                    std::copy(taking + begin, taking + until, order);
                else
                    simd::ramp(order, until - begin, static_cast<int>(begin), 1, level);
                c.next += until - begin;
                begin = until;
            };
            if (begin <= c.start && c.start < end) {
                append(c.start);
                c.next = result.starts[index(label)];
            }
            append(end);
        }
    }

private:
    struct Cluster {
        std::size_t firstRun, lastRun, size;
        std::size_t start, next; // the first point in order; where the next point of the order goes
        std::size_t before = 0;  // points before `start` in the order of the scan
    };

    template <typename Nearness>
    void startAfterWidestGap(const RunClusters &runs, const Nearness &nearness, int label) {
        Cluster &c = clusters_[index(label)];
        auto widest = nearness.gap(c.start, runs.begin(c.lastRun + 1) - 1);
        std::size_t seen = 0, last = 0; // points of the cluster, and the last one of them
        for (std::size_t run = c.firstRun; run <= c.lastRun; ++run) {
            if (label_[run] != label)
                continue;
            const std::size_t begin = runs.begin(run), end = runs.begin(run + 1);
            const auto compare = [&](std::size_t i, std::size_t before) {
                if (const auto gap = nearness.gap(i, before); gap > widest) {
                    widest = gap;
                    c.start = i;
                    c.before = seen + (i - begin);
                }
            };
            if (run != c.firstRun)
                compare(begin, last);
            for (std::size_t i = begin + 1, next; i < end; i = next) {
                next = std::min(end, ((i - 1) / NearWord::bits + 1) * NearWord::bits + 1);
                if (runs.widestNear(i) > static_cast<double>(widest))
                    for (; i < next; ++i)
                        compare(i, i - 1);
            }
            seen += end - begin;
            last = end - 1;
        }
    }
    static std::size_t index(int i) { return static_cast<std::size_t>(i); }

    std::vector<std::size_t> size_; // points of the cluster that begins with each run
    std::vector<int> label_;        // of each run
    std::vector<Cluster> clusters_;
};

} // namespace vectorlib
