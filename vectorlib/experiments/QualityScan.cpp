#include "vectorlib/experiments/QualityScan.h"

#include "vectorlib/observation/Observer.h"
#include "vectorlib/segmentation/EarSegmenter.h"

#include <cmath>

namespace hermes::experiments {

namespace {

using Point = vectorlib::Vector2D<double>;

constexpr int polygonRays = 360;
constexpr double rangeNoise = 0.03;                        // metres
constexpr double angleNoise = 0.2 * vectorlib::pi / 180.0; // radians

Point directionOf(double angle) {
    return {std::cos(angle), std::sin(angle)};
}

double nearestHit(const Edges &edges, Point direction) {
    double nearest = vectorlib::noHit;
    for (const auto &edge : edges)
        nearest = std::min(nearest, vectorlib::rayDistance(direction, edge.begin(), edge.end()));
    return nearest;
}

// Radii of the paper: (P + 1) / (l + 1) of the scale for P from a Poisson distribution of mean l = n^2 / 5.
Edges randomPolygon(int vertices, std::mt19937_64 &random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const double scale = 5 + 5 * uniform(random), turn = uniform(random), mean = vertices * vertices / 5.0;
    std::poisson_distribution<int> radius(mean);
    std::vector<Point> corners;
    for (int i = 0; i < vertices; ++i)
        corners.push_back(directionOf(turn + 2 * vectorlib::pi * i / vertices) * scale *
                          ((radius(random) + 1) / (mean + 1)));
    Edges sides;
    for (std::size_t i = 0; i < corners.size(); ++i)
        sides.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
    return sides;
}

} // namespace

QualityScan polygonScan(int vertices, std::mt19937_64 &random) {
    std::normal_distribution<double> normal;
    const Edges sides = randomPolygon(vertices, random);
    QualityCluster cluster;
    for (int i = 0; i < polygonRays; ++i) {
        const double angle = 2 * vectorlib::pi * i / polygonRays;
        const double seen = nearestHit(sides, directionOf(angle + angleNoise * normal(random)));
        const Point direction = directionOf(angle);
        cluster.add({direction, seen + rangeNoise * normal(random), nearestHit(sides, direction)});
    }
    return {cluster};
}

QualityScan logScan(const vectorlib::CarmenScan &scan) {
    QualityCluster all;
    for (std::size_t i = 0; i < scan.ranges.size(); ++i)
        if (scan.isReturn(i))
            all.add({directionOf(scan.startAngle + scan.angleStep * static_cast<double>(i)),
                     double(scan.ranges[i]), 0});
    vectorlib::EarSegmenter<float> segment;
    segment.settings = vectorlib::EarSettings::forScanner(
        scan.angleStep * static_cast<double>(scan.ranges.size()), scan.ranges.size());
    const vectorlib::Segmentation &found = segment(all.points);
    QualityScan clusters(found.size());
    for (std::size_t c = 0; c < found.size(); ++c)
        for (std::size_t p = found.starts[c]; p < found.starts[c + 1]; ++p)
            clusters[c].add(all.rays[static_cast<std::size_t>(found.order[p])]);
    return clusters;
}

void QualityMeasures::take(const QualityCluster &cluster, const Edges &polyline) {
    for (const QualityCluster::Ray &ray : cluster.rays) {
        const double range = nearestHit(polyline, ray.direction);
        ++rays_;
        if (range >= vectorlib::noHit)
            continue;
        ++hits_;
        squares_ += (range - ray.measured) * (range - ray.measured);
        area_ += ray.truth * ray.truth;
        if (ray.truth > 0)
            areaBetween_ += std::abs(range * range - ray.truth * ray.truth);
    }
}

std::size_t countVertices(const Edges &polyline) {
    std::size_t vertices = polyline.empty() ? 0 : 2;
    for (std::size_t i = 1; i < polyline.size(); ++i)
        vertices += polyline[i - 1].end() == polyline[i].begin() ? 1 : 2;
    return vertices;
}

} // namespace hermes::experiments
