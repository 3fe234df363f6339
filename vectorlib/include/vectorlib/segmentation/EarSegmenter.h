#pragma once

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/segmentation/ClusterOrder.h"
#include "vectorlib/segmentation/PolarScan.h"

#include <algorithm>
#include <climits>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

namespace vectorlib {

/// Settings of EarSegmenter; the defaults are those of thesis 5.3.
struct EarSettings {
    /// In which two points are compared (thesis 5.2.2): by their distance, or range and angle by themselves.
    enum class Coordinates { Cartesian, Polar };

    int neighbours = 10;           ///< K: how many earlier points are examined
    double minThreshold = 0.05;    ///< lower bound of the distance threshold, the sensor's accuracy; metres
    double maxThreshold = 0.20;    ///< upper bound of the distance threshold; metres
    int minPoints = 15;            ///< smaller clusters are outliers
    bool closed = true;            ///< the last point is a neighbour of the first (a full turn)
    double fieldOfView = 2 * pi;   ///< F of erratum 14; radians
    std::size_t nominalPoints = 0; ///< N of erratum 14, the scanner's rays; 0: as many as points
    Coordinates coordinates = Coordinates::Cartesian; ///< of points; ranges are always compared as such

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

/// Splits an ordered scan into continuous clusters: Euclidean distance (or range and angle by themselves, see
/// settings), adaptive threshold, retroactive merging. Thesis 5.2. Points are in the scanner's frame, in
/// order of acquisition. Non-finite points are outliers and take no part. Keeps its buffers between calls: no
/// allocation once they have grown.
template <typename Scalar = float>
class EarSegmenter {
    static_assert(std::is_floating_point_v<Scalar>, "points of float or double; integers as PolarScan");

public:
    EarSettings settings;
    simd::Level level = simd::bestLevel(); ///< the instruction set to use

    /// The clusters of points, in the coordinates of the settings. Valid until the next call.
    const Segmentation &operator()(PointSpan<Scalar> points) {
        if (settings.coordinates == EarSettings::Coordinates::Polar)
            return inPolarCoordinates(points);
        const double k = thresholdPerMetre(points.size()), low = bounded(settings.minThreshold);
        const double high = bounded(settings.maxThreshold);
        Comparison<CartesianNearness<Scalar>> comparison{
            {points.begin(), points.size(), {Scalar(k * k), Scalar(low * low), Scalar(high * high)}}, level};
        runs_.split(comparison);
        if (allFinite(points))
            return join(comparison, points.size(), nullptr);
        takeFinite(points);
        comparison.nearness.points = finite_.data();
        comparison.nearness.count = finite_.size();
        runs_.split(comparison);
        return join(comparison, points.size(), taking_.data());
    }

    /// Ranges straight from a lidar, with the threshold in polar coordinates (thesis 5.2.2): a neighbour is
    /// at most K rays away and its range differs by at most K F / N of the range (5.1), within the bounds.
    /// What is no return is an outlier and takes no part. Indices are those of the rays.
    template <typename Range>
    const Segmentation &operator()(const PolarScan<Range> &scan) {
        returns_.take(scan, level);
        const Comparison<PolarNearness> comparison{
            {returns_.ranges.data(), returns_.rays.data(), returns_.count, rangeThreshold(scan.count),
             static_cast<int>(reach()), settings.closed ? static_cast<int>(scan.count) : INT_MAX,
             std::abs(scan.step)},
            level};
        runs_.split(comparison);
        return join(comparison, scan.count, returns_.count < scan.count ? returns_.rays.data() : nullptr);
    }

private:
    // The same with points: a neighbour is at most K even steps of the field of view away.
    const Segmentation &inPolarCoordinates(PointSpan<Scalar> points) {
        returns_.take(points);
        const double half = 0.5 / static_cast<double>(reach()); // a step, for directions that are rounded
        const double angle = std::min(thresholdPerMetre(points.size()) * (1 + half), 2 * pi);
        const Comparison<PolarNearness> comparison{
            {returns_.ranges.data(), returns_.rays.data(), returns_.count, rangeThreshold(points.size()),
             static_cast<int>(angle / PolarReturns::direction), PolarReturns::turn, PolarReturns::direction},
            level};
        runs_.split(comparison);
        return join(comparison, points.size(),
                    returns_.count < points.size() ? returns_.taken.data() : nullptr);
    }
    NearThreshold<float> rangeThreshold(std::size_t count) const {
        return {static_cast<float>(thresholdPerMetre(count)),
                static_cast<float>(bounded(settings.minThreshold)),
                static_cast<float>(bounded(settings.maxThreshold))};
    }
    // Thesis (5.1) with erratum 14: K * F / N for each metre of range.
    double thresholdPerMetre(std::size_t count) const {
        const std::size_t rays = settings.nominalPoints ? settings.nominalPoints : count;
        return rays ? bounded(settings.neighbours * settings.fieldOfView / static_cast<double>(rays)) : 0;
    }
    // A threshold whose square is a float; 0 for what is negative or no number.
    static double bounded(double threshold) { return std::min(std::max(0.0, threshold), 1e9); }
    std::size_t reach() const { return static_cast<std::size_t>(std::max(1, settings.neighbours)); }

    // A point that is not finite is near no other: a run of its own.
    bool isFinite(PointSpan<Scalar> points, std::size_t run) const {
        return runs_.length(run) > 1 || points[runs_.begin(run)].isFinite();
    }
    bool allFinite(PointSpan<Scalar> points) const {
        for (std::size_t run = 0; run < runs_.runs(); ++run)
            if (!isFinite(points, run))
                return false;
        return true;
    }
    void takeFinite(PointSpan<Scalar> points) {
        taking_.clear();
        finite_.clear();
        for (std::size_t run = 0; run < runs_.runs(); ++run)
            if (isFinite(points, run)) {
                const std::size_t begin = runs_.begin(run), end = runs_.begin(run + 1);
                finite_.insert(finite_.end(), points.begin() + begin, points.begin() + end);
                taking_.resize(finite_.size());
                std::iota(taking_.end() - static_cast<std::ptrdiff_t>(end - begin), taking_.end(),
                          static_cast<int>(begin));
            }
    }

    // `taking`: the points that take part, of `count`; null: all.
    template <typename Nearness>
    const Segmentation &join(const Comparison<Nearness> &comparison, std::size_t count, const int *taking) {
        runs_.join(comparison, reach(), settings.closed);
        order_.number(runs_, static_cast<std::size_t>(std::max(1, settings.minPoints)));
        if (settings.closed)
            order_.startAfterWidestGaps(runs_, comparison, reach());
        order_.write(runs_, taking, count, level, result_);
        return result_;
    }

    RunClusters runs_;
    ClusterOrder order_;
    std::vector<int> taking_;              // the points that take part, where some do not
    std::vector<Vector2D<Scalar>> finite_; // these points
    PolarReturns returns_;
    Segmentation result_;
};

} // namespace vectorlib
