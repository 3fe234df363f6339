#include "gui/vector/experiment/QualityExperiment.h"

#include "gui/vector/experiment/Algorithms.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/observation/Ray.h"
#include "vectorlib/segmentation/EarSegmenter.h"

#include <algorithm>
#include <map>
#include <random>

namespace hermes {

namespace {

using Point = vectorlib::Vector2D<double>;
using Cluster = std::vector<vectorlib::Vector2D<float>>;
using Segments = std::vector<vectorlib::LineSegment2D<double>>;

constexpr int polygonRays = 360;
constexpr double polygonNoise = 0.02; // metres
constexpr double sigmas[] = {0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.06, 0.08, 0.12, 0.2, 0.3};

/// A ray: its direction, what was measured, what is true (0 where not known).
struct Ray {
    Point direction;
    double measured;
    double truth;
};

double nearestHit(const Segments &segments, Point direction) {
    double nearest = vectorlib::noHit;
    for (const auto &s : segments)
        nearest = std::min(nearest, vectorlib::rayDistance(direction, s.begin(), s.end()));
    return nearest;
}

/// Adds up the measures of one algorithm at one sigma.
struct Sum {
    double scans = 0, vertices = 0, squares = 0, hits = 0, rays = 0, areaBetween = 0, area = 0;

    void take(const Segments &polylines, const std::vector<Ray> &measured) {
        ++scans;
        for (std::size_t i = 0; i < polylines.size(); ++i)
            vertices += i > 0 && polylines[i - 1].end() == polylines[i].begin() ? 1 : 2;
        for (const Ray &ray : measured) {
            const double range = nearestHit(polylines, ray.direction);
            ++rays;
            area += ray.truth * ray.truth;
            if (range >= vectorlib::noHit)
                continue;
            ++hits;
            squares += (range - ray.measured) * (range - ray.measured);
            if (ray.truth > 0)
                areaBetween += std::abs(range * range - ray.truth * ray.truth);
        }
    }
    QualityRow row(int verticesTrue, const std::string &algorithm, double sigma) const {
        return {verticesTrue,
                algorithm,
                sigma,
                vertices / scans,
                hits > 0 ? std::sqrt(squares / hits) : 0,
                hits / rays,
                area > 0 ? areaBetween / area : 0};
    }
};

Segments extract(const Algorithm &algorithm, const std::vector<Cluster> &clusters) {
    Segments segments;
    for (const Cluster &cluster : clusters)
        for (const vectorlib::VectorizedLine &line : algorithm.run(cluster))
            if (line.segment.isFinite())
                segments.push_back(line.segment);
    return segments;
}

/// A polygon whose corners lie all around the origin, as seen by a scanner there.
std::vector<Ray> polygonScan(int vertices, std::mt19937_64 &random) {
    std::uniform_real_distribution<double> radius(3, 6), jitter(-0.3, 0.3);
    std::normal_distribution<double> noise(0, polygonNoise);
    std::vector<Point> corners;
    for (int i = 0; i < vertices; ++i) {
        const double angle = 2 * vectorlib::pi * (i + jitter(random)) / vertices;
        corners.push_back(Point(std::cos(angle), std::sin(angle)) * radius(random));
    }
    Segments sides;
    for (std::size_t i = 0; i < corners.size(); ++i)
        sides.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
    std::vector<Ray> rays;
    for (int i = 0; i < polygonRays; ++i) {
        const double angle = 2 * vectorlib::pi * i / polygonRays;
        const Point direction(std::cos(angle), std::sin(angle));
        const double truth = nearestHit(sides, direction);
        rays.push_back({direction, truth + noise(random), truth});
    }
    return rays;
}

/// Runs every algorithm at every sigma over scans, each given as rays and clusters.
class Sweep {
public:
    void take(const std::vector<Ray> &rays, const std::vector<Cluster> &clusters) {
        for (std::size_t s = 0; s < std::size(sigmas); ++s)
            for (std::size_t a = 0; a < algorithms_[s].size(); ++a)
                sums_[{a, s}].take(extract(algorithms_[s][a], clusters), rays);
    }
    void append(std::vector<QualityRow> &rows, int verticesTrue) const {
        for (const auto &[key, sum] : sums_)
            rows.push_back(
                sum.row(verticesTrue, algorithms_[key.second][key.first].label, sigmas[key.second]));
    }
    Sweep() {
        for (const double sigma : sigmas)
            algorithms_.push_back(comparedAlgorithms(sigma, true));
    }

private:
    std::vector<std::vector<Algorithm>> algorithms_; // by sigma
    std::map<std::pair<std::size_t, std::size_t>, Sum> sums_;
};

} // namespace

std::vector<QualityRow> polygonExperiment(const ExperimentOptions &options) {
    constexpr int counts[] = {6, 12, 24, 48, 90, 180};
    std::vector<QualityRow> rows;
    std::mt19937_64 random(options.seed);
    std::size_t done = 0;
    for (const int vertices : counts) {
        Sweep sweep;
        for (int run = 0; run < options.runs; ++run) {
            const std::vector<Ray> rays = polygonScan(vertices, random);
            Cluster cluster;
            for (const Ray &ray : rays)
                cluster.emplace_back(ray.direction * ray.measured);
            sweep.take(rays, {cluster});
            if (options.progress)
                options.progress(++done, std::size(counts) * static_cast<std::size_t>(options.runs));
        }
        sweep.append(rows, vertices);
    }
    return rows;
}

std::vector<QualityRow> logExperiment(const std::vector<vectorlib::CarmenScan> &scans,
                                      const ExperimentOptions &options) {
    Sweep sweep;
    vectorlib::EarSegmenter<float> segment;
    const std::size_t step =
        std::max<std::size_t>(1, scans.size() / static_cast<std::size_t>(10 * options.runs));
    for (std::size_t i = 0; i < scans.size(); i += step) {
        const vectorlib::CarmenScan &scan = scans[i];
        std::vector<Ray> rays;
        Cluster points;
        for (std::size_t k = 0; k < scan.ranges.size(); ++k)
            if (scan.isReturn(k)) {
                const double angle = scan.startAngle + scan.angleStep * static_cast<double>(k);
                rays.push_back({{std::cos(angle), std::sin(angle)}, double(scan.ranges[k]), 0});
                points.emplace_back(rays.back().direction * rays.back().measured);
            }
        segment.settings = vectorlib::EarSettings::forScanner(
            scan.angleStep * static_cast<double>(scan.ranges.size()), scan.ranges.size());
        const vectorlib::Segmentation &found = segment(points);
        std::vector<Cluster> clusters(found.size());
        for (std::size_t c = 0; c < found.size(); ++c)
            for (std::size_t p = found.starts[c]; p < found.starts[c + 1]; ++p)
                clusters[c].push_back(points[static_cast<std::size_t>(found.order[p])]);
        sweep.take(rays, clusters);
        if (options.progress)
            options.progress(i + 1, scans.size());
    }
    std::vector<QualityRow> rows;
    if (!scans.empty())
        sweep.append(rows, 0);
    return rows;
}

void writeCsv(std::ostream &out, const std::vector<QualityRow> &rows) {
    using vectorlib::Number;
    out << "vertices_true,algorithm,sigma,vertices,rmse,hit_share,area_error\n";
    for (const QualityRow &r : rows)
        out << r.verticesTrue << ',' << r.algorithm << ',' << Number(r.sigma) << ',' << Number(r.vertices)
            << ',' << Number(r.rmse) << ',' << Number(r.hitShare) << ',' << Number(r.areaError) << '\n';
}

std::vector<Plot> plotsOf(const std::vector<QualityRow> &rows) {
    std::map<int, std::map<std::string, std::vector<const QualityRow *>>> sorted;
    for (const QualityRow &row : rows)
        sorted[row.verticesTrue][row.algorithm].push_back(&row);
    std::vector<Plot> plots;
    for (const auto &[vertices, algorithms] : sorted) {
        const std::string what = vertices ? std::to_string(vertices) + " vertices" : "log";
        const std::string prefix = vertices ? std::to_string(vertices) + "-" : "";
        const auto add = [&](const char *name, const char *axis, double QualityRow::*quantity) {
            Plot plot{prefix + name, what, "vertices found", axis, true, false, {}};
            for (const Algorithm &algorithm : comparedAlgorithms(1, true)) {
                const auto found = algorithms.find(algorithm.label);
                if (found == algorithms.end())
                    continue;
                Curve curve{algorithm.label, algorithm.colour, {}};
                for (const QualityRow *row : found->second)
                    curve.points.emplace_back(row->vertices, row->*quantity);
                plot.curves.push_back(std::move(curve));
            }
            plots.push_back(std::move(plot));
        };
        add("rmse", "RMSE [m]", &QualityRow::rmse);
        add("hits", "share of rays that hit", &QualityRow::hitShare);
        if (vertices)
            add("area", "relative area error", &QualityRow::areaError);
    }
    return plots;
}

} // namespace hermes
