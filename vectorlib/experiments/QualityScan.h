#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/io/CarmenLog.h"

#include <cmath>
#include <random>
#include <vector>

namespace hermes::experiments {

/// A cluster of a scan: the points that an extractor gets, and the rays from the scanner at the origin that
/// they came from.
struct QualityCluster {
    struct Ray {
        vectorlib::Vector2D<double> direction;
        double measured; ///< metres
        double truth;    ///< metres; 0 where it is not known
    };
    std::vector<vectorlib::Vector2D<float>> points;
    std::vector<Ray> rays;

    void add(const Ray &ray) {
        rays.push_back(ray);
        points.emplace_back(ray.direction * ray.measured);
    }
};
using QualityScan = std::vector<QualityCluster>;

/// A random closed polygon around the scanner, 360 rays over the full turn, one cluster. As in the paper:
/// radii scatter by sqrt(5) / vertices of their mean, 5 to 10 m; noise of 3 cm along the ray and 0.2 degrees.
QualityScan polygonScan(int vertices, std::mt19937_64 &random);
/// The returns of a real scan that segmentation gives to the extractors.
QualityScan logScan(const vectorlib::CarmenScan &scan);

using Edges = std::vector<vectorlib::LineSegment2D<double>>;

/// The measures of Schaefer et al., 2018: how well polylines stand for the rays of a scan. Every ray is
/// measured against the polyline of its own cluster; what stands before or behind that is an affair of the
/// segmentation.
class QualityMeasures {
public:
    void take(const QualityCluster &cluster, const Edges &polyline);

    /// Root mean square of the measured ranges from the polylines, rays that hit; metres.
    double rmse() const { return hits_ > 0 ? std::sqrt(squares_ / hits_) : 0; }
    /// f: rays that hit, of all.
    double hitShare() const { return rays_ > 0 ? hits_ / rays_ : 0; }
    /// a: area between true and extracted polygon over the true area, rays that hit; 0 where the truth is not
    /// known.
    double areaError() const { return area_ > 0 ? areaBetween_ / area_ : 0; }

private:
    double rays_ = 0, hits_ = 0, squares_ = 0, area_ = 0, areaBetween_ = 0;
};

/// J of a polyline: consecutive edges share a vertex where one begins exactly where the other ends.
std::size_t countVertices(const Edges &polyline);

} // namespace hermes::experiments
