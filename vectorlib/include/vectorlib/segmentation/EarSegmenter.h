#pragma once

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/PointSpan.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// Settings of EarSegmenter; the defaults are those of thesis 5.3.
struct EarSettings {
    int neighbours = 10;           ///< K: how many earlier points are examined
    double minThreshold = 0.05;    ///< lower bound of the distance threshold, the sensor's accuracy; metres
    double maxThreshold = 0.20;    ///< upper bound of the distance threshold; metres
    int minPoints = 15;            ///< smaller clusters are outliers
    bool closed = true;            ///< the last point is a neighbour of the first (a full turn)
    double fieldOfView = 2 * pi;   ///< F of erratum 14; radians
    std::size_t nominalPoints = 0; ///< N of erratum 14, the scanner's rays; 0: as many as points

    /// For a scanner of `rays` rays over `fieldOfView` (radians, 2 pi for a full turn). Up to 0.3 degree
    /// between rays the settings of thesis 5.3; beyond, points of one wall lie farther apart and small
    /// clusters count.
    static EarSettings forScanner(double fieldOfView, std::size_t rays) {
        EarSettings s;
        s.fieldOfView = fieldOfView;
        s.nominalPoints = rays;
        s.closed = fieldOfView > 1.99 * pi;
        if (rays > 0 && fieldOfView / static_cast<double>(rays) > 0.3 * pi / 180) {
            s.neighbours = 5;
            s.minThreshold = 0.10;
            s.maxThreshold = 0.60;
            s.minPoints = 4;
        }
        return s;
    }
};

/// What a segmentation found; indices are those of the points given.
struct Segmentation {
    std::vector<int> labels; ///< the cluster of each point, -1 for an outlier
    std::vector<int> order;  ///< the points of all clusters, cluster after cluster, each in scanning order
    std::vector<std::size_t> starts; ///< cluster c holds order[starts[c]] .. order[starts[c + 1] - 1]

    std::size_t size() const { return starts.empty() ? 0 : starts.size() - 1; }
    std::size_t size(std::size_t cluster) const { return starts[cluster + 1] - starts[cluster]; }
};

/// Splits an ordered scan into continuous clusters: Euclidean distance, adaptive threshold, retroactive
/// merging. Thesis 5.2. Points are in the scanner's frame, in order of acquisition. Non-finite points are
/// outliers and take no part. Keeps its buffers between calls: no allocation once they have grown.
template <typename Scalar = float>
class EarSegmenter {
public:
    EarSettings settings;

    const Segmentation &operator()(PointSpan<Scalar> points) {
        const std::size_t count = points.size();
        parent_.resize(count);
        threshold_.resize(count);
        valid_.clear();
        const double perMetre = thresholdPerMetre(count);
        for (std::size_t i = 0; i < count; ++i) {
            parent_[i] = static_cast<int>(i);
            if (points[i].isFinite()) {
                const double t =
                    std::clamp(perMetre * points[i].norm(), settings.minThreshold, settings.maxThreshold);
                threshold_[i] = static_cast<Scalar>(t * t);
                valid_.push_back(static_cast<int>(i));
            }
        }
        const std::size_t reach = static_cast<std::size_t>(std::max(1, settings.neighbours));
        for (std::size_t v = 1; v < valid_.size(); ++v)
            for (std::size_t back = 1; back <= std::min(reach, v); ++back)
                joinIfNear(points, valid_[v], valid_[v - back]);
        if (settings.closed)
            close(points, reach);
        collect(points);
        return result_;
    }

private:
    // Thesis (5.1) with erratum 14: K * F / N for each metre of range.
    double thresholdPerMetre(std::size_t count) const {
        const std::size_t rays = settings.nominalPoints ? settings.nominalPoints : count;
        return rays ? settings.neighbours * settings.fieldOfView / static_cast<double>(rays) : 0;
    }
    int root(int i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    // The earlier root stays, so that clusters are numbered by their first point.
    void joinIfNear(PointSpan<Scalar> points, int i, int j) {
        if (!((points[i] - points[j]).squaredNorm() <= threshold_[i]))
            return;
        const int a = root(i), b = root(j);
        parent_[std::max(a, b)] = std::min(a, b);
    }
    // The first K points are examined again, with the last ones as their predecessors.
    void close(PointSpan<Scalar> points, std::size_t reach) {
        const std::size_t valid = valid_.size();
        for (std::size_t v = 0; v < std::min(reach, valid); ++v)
            for (std::size_t back = v + 1; back <= reach && back < valid; ++back)
                joinIfNear(points, valid_[v], valid_[valid + v - back]);
    }
    void collect(PointSpan<Scalar> points) {
        const std::size_t count = points.size();
        Segmentation &r = result_;
        r.labels.assign(count, -1);
        r.starts.assign(1, 0);
        size_.assign(count, 0);
        for (int i : valid_)
            ++size_[root(i)];
        int clusters = 0;
        for (int i : valid_)
            if (parent_[i] == i && size_[i] >= std::max(1, settings.minPoints)) {
                r.labels[i] = clusters++;
                r.starts.push_back(r.starts.back() + static_cast<std::size_t>(size_[i]));
            }
        r.order.resize(r.starts.back());
        next_.assign(r.starts.begin(), r.starts.end());
        for (int i : valid_) {
            const int label = r.labels[root(i)];
            r.labels[i] = label;
            if (label >= 0)
                r.order[next_[static_cast<std::size_t>(label)]++] = i;
        }
        if (settings.closed)
            for (std::size_t c = 0; c < r.size(); ++c)
                startAfterWidestGap(points, c);
    }
    // A cluster that runs over the end of the scan begins after the widest gap between its points.
    void startAfterWidestGap(PointSpan<Scalar> points, std::size_t cluster) {
        const auto first = result_.order.begin() + static_cast<std::ptrdiff_t>(result_.starts[cluster]);
        const auto last = result_.order.begin() + static_cast<std::ptrdiff_t>(result_.starts[cluster + 1]);
        const std::size_t reach = std::min(valid_.size(), static_cast<std::size_t>(settings.neighbours));
        if (*first > valid_[reach - 1] || *(last - 1) < valid_[valid_.size() - reach])
            return;
        const auto gap = [&](int i, int j) { return (points[i] - points[j]).squaredNorm(); };
        auto start = first;
        Scalar widest = gap(*first, *(last - 1));
        for (auto i = first + 1; i != last; ++i)
            if (const Scalar g = gap(*i, *(i - 1)); g > widest) {
                widest = g;
                start = i;
            }
        std::rotate(first, start, last);
    }

    std::vector<int> parent_;
    std::vector<Scalar> threshold_; // squared, of each point
    std::vector<int> valid_;        // indices of the finite points
    std::vector<int> size_;
    std::vector<std::size_t> next_;
    Segmentation result_;
};

} // namespace vectorlib
