#pragma once

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/segmentation/Nearness.h"
#include "vectorlib/segmentation/PolarScan.h"
#include "vectorlib/segmentation/RunClusters.h"

#include <algorithm>
#include <numeric>
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
    simd::Level level = simd::bestLevel(); ///< the instruction set to use

    const Segmentation &operator()(PointSpan<Scalar> points) {
        const double k = thresholdPerMetre(points.size()), low = settings.minThreshold;
        const double high = settings.maxThreshold;
        CartesianNearness<Scalar> nearness{points.begin(), Scalar(k * k), Scalar(low * low),
                                           Scalar(high * high)};
        if (allFinite(points))
            return segment(nearness, points.size(), points.size());
        valid_.clear();
        compact_.clear();
        for (std::size_t i = 0; i < points.size(); ++i)
            if (points[i].isFinite()) {
                valid_.push_back(static_cast<int>(i));
                compact_.push_back(points[i]);
            }
        nearness.points = compact_.data();
        return segment(nearness, points.size(), valid_.size());
    }

    /// Ranges straight from a lidar, with the threshold in polar coordinates (thesis 5.2.2): a neighbour is
    /// at most K rays away and its range differs by at most K F / N of the range (5.1), within the bounds.
    /// What is no return is an outlier and takes no part. Indices are those of the rays.
    template <typename Range>
    const Segmentation &operator()(const PolarScan<Range> &scan) {
        valid_.clear();
        ranges_.clear();
        for (std::size_t i = 0; i < scan.count; ++i)
            if (const double r = scan.range(i); scan.isReturn(r)) {
                valid_.push_back(static_cast<int>(i));
                ranges_.push_back(static_cast<float>(r));
            }
        const PolarNearness nearness{ranges_.data(),
                                     valid_.data(),
                                     static_cast<float>(thresholdPerMetre(scan.count)),
                                     static_cast<float>(settings.minThreshold),
                                     static_cast<float>(settings.maxThreshold),
                                     static_cast<int>(reach()),
                                     settings.closed ? static_cast<int>(scan.count) : 0,
                                     std::abs(scan.step)};
        return segment(nearness, scan.count, valid_.size());
    }

private:
    // Thesis (5.1) with erratum 14: K * F / N for each metre of range.
    double thresholdPerMetre(std::size_t count) const {
        const std::size_t rays = settings.nominalPoints ? settings.nominalPoints : count;
        return rays ? settings.neighbours * settings.fieldOfView / static_cast<double>(rays) : 0;
    }
    std::size_t reach() const { return static_cast<std::size_t>(std::max(1, settings.neighbours)); }

    // 0 times a number is 0, times infinity or NaN it is NaN: sums in lanes, without branches.
    static bool allFinite(PointSpan<Scalar> points) {
        constexpr std::size_t lanes = 16;
        const std::size_t count = points.size(), eights = count / (lanes / 2) * (lanes / 2);
        const Scalar *p = count ? &points.begin()->x : nullptr;
        Scalar sum[lanes] = {};
        for (std::size_t i = 0; i < 2 * eights; i += lanes)
            for (std::size_t k = 0; k < lanes; ++k)
                sum[k] += p[i + k] * Scalar(0);
        for (std::size_t i = 2 * eights; i < 2 * count; ++i)
            sum[0] += p[i] * Scalar(0);
        for (std::size_t k = 1; k < lanes; ++k)
            sum[0] += sum[k];
        return sum[0] == Scalar(0);
    }

    // `taking` of `count` points take part: those of valid_, or all.
    template <typename Nearness>
    const Segmentation &segment(const Nearness &nearness, std::size_t count, std::size_t taking) {
        all_ = taking == count;
        runs_.find(nearness, taking, reach(), settings.closed, level);
        number(count);
        if (settings.closed)
            for (std::size_t c = 0; c < result_.size(); ++c)
                startAfterWidestGap(nearness, c, taking);
        if (!all_)
            for (int &i : result_.order)
                i = valid_[static_cast<std::size_t>(i)];
        return result_;
    }
    // Labels and order, run by run.
    void number(std::size_t count) {
        Segmentation &r = result_;
        size_.assign(runs_.runs(), 0);
        for (std::size_t run = 0; run < size_.size(); ++run)
            size_[runs_.root(run)] += runs_.length(run);
        label_.assign(size_.size(), -1);
        r.starts.assign(1, 0);
        for (std::size_t run = 0; run < size_.size(); ++run)
            if (size_[run] >= static_cast<std::size_t>(std::max(1, settings.minPoints))) {
                label_[run] = static_cast<int>(r.starts.size() - 1);
                r.starts.push_back(r.starts.back() + size_[run]);
            }
        next_.assign(r.starts.begin(), r.starts.end());
        r.order.resize(r.starts.back());
        r.labels.resize(count);
        if (!all_)
            std::fill(r.labels.begin(), r.labels.end(), -1);
        for (std::size_t run = 0; run < size_.size(); ++run)
            numberRun(runs_.begin(run), runs_.begin(run + 1), label_[runs_.root(run)]);
    }
    void numberRun(std::size_t begin, std::size_t end, int label) {
        int *labels = result_.labels.data();
        if (all_)
            std::fill(labels + begin, labels + end, label);
        else
            for (std::size_t i = begin; i < end; ++i)
                labels[valid_[i]] = label;
        if (label < 0)
            return;
        int *order = result_.order.data() + next_[static_cast<std::size_t>(label)];
        next_[static_cast<std::size_t>(label)] += end - begin;
        // Counted among those that take part, until segment() is done.
        std::iota(order, order + (end - begin), static_cast<int>(begin));
    }
    // A cluster that runs over the end of the scan begins after the widest gap between its points.
    template <typename Nearness>
    void startAfterWidestGap(const Nearness &nearness, std::size_t cluster, std::size_t taking) {
        const auto first = result_.order.begin() + static_cast<std::ptrdiff_t>(result_.starts[cluster]);
        const auto last = result_.order.begin() + static_cast<std::ptrdiff_t>(result_.starts[cluster + 1]);
        const std::size_t near = std::min(taking, static_cast<std::size_t>(settings.neighbours));
        if (static_cast<std::size_t>(*first) + 1 > near ||
            static_cast<std::size_t>(*(last - 1)) < taking - near)
            return;
        Gap<decltype(nearness.gap(0, 0))> widest{nearness.gap(index(*first), index(*(last - 1))),
                                                 index(*first)};
        std::size_t before = 0;
        for (std::size_t run = 0; run < runs_.runs(); ++run) {
            const std::size_t begin = runs_.begin(run), end = runs_.begin(run + 1);
            if (label_[runs_.root(run)] != static_cast<int>(cluster))
                continue;
            if (begin != index(*first))
                if (const auto g = nearness.gap(begin, before); g > widest.size)
                    widest = {g, begin};
            nearness.widen(begin, end, level, widest);
            before = end - 1;
        }
        std::rotate(first, std::lower_bound(first, last, static_cast<int>(widest.at)), last);
    }
    static std::size_t index(int i) { return static_cast<std::size_t>(i); }

    RunClusters runs_;
    bool all_ = true;                       // every point takes part
    std::vector<int> valid_;                // the points that take part
    std::vector<Vector2D<Scalar>> compact_; // these points, where some do not
    std::vector<float> ranges_;             // the ranges of polar input
    std::vector<std::size_t> size_, next_;
    std::vector<int> label_;
    Segmentation result_;
};

} // namespace vectorlib
