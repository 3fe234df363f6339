#include "gui/vector/experiment/VectorizationExperiment.h"

#include "gui/vector/experiment/Algorithms.h"
#include "gui/vector/experiment/Timing.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/observation/SimulatedScanner.h"
#include "vectorlib/segmentation/EarSegmenter.h"

#include <algorithm>

namespace hermes::vector {

namespace {

using Point = vectorlib::Vector2D<float>;
using Cluster = std::vector<Point>;

constexpr std::size_t pointCounts[] = {200, 500, 1000, 2000, 5000, 10000, 20000};
constexpr double scannerNoise = 0.01; // metres
constexpr double sceneSigma = 0.02;   // metres

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::vector<Cluster> clustersOf(const std::vector<Point> &scan, std::size_t rays) {
    vectorlib::EarSegmenter<float> segment;
    segment.settings.nominalPoints = rays;
    const vectorlib::Segmentation &found = segment(scan);
    std::vector<Cluster> clusters(found.size());
    for (std::size_t c = 0; c < found.size(); ++c)
        for (std::size_t i = found.starts[c]; i < found.starts[c + 1]; ++i)
            clusters[c].push_back(scan[static_cast<std::size_t>(found.order[i])]);
    return clusters;
}

/// Collects what one algorithm does on several scans.
class Collector {
public:
    explicit Collector(const Algorithm &algorithm)
        : algorithm_(algorithm) {}

    void take(const std::vector<Cluster> &clusters,
              const std::vector<vectorlib::LineSegment2D<float>> &truth) {
        std::vector<vectorlib::LineSegment2D<float>> found;
        for (const Cluster &cluster : clusters)
            for (const vectorlib::VectorizedLine &line : algorithm_.run(cluster))
                if (line.segment.isFinite())
                    found.emplace_back(line.segment);
        lines_ += static_cast<double>(found.size());
        area_ += truth.empty() ? 0 : errorArea(truth, found);
        times_.push_back(timeOf([&] {
            for (const Cluster &cluster : clusters)
                algorithm_.run(cluster);
        }));
    }
    ResultRow row(double sigma, std::size_t points, std::size_t linesTrue) const {
        ResultRow r;
        r.sigma = sigma;
        r.points = points;
        r.algorithm = algorithm_.label;
        r.runs = static_cast<int>(times_.size());
        r.linesTrue = static_cast<double>(linesTrue);
        r.linesFound = lines_ / r.runs;
        r.area = area_ / r.runs;
        r.microseconds = median(times_);
        return r;
    }

private:
    const Algorithm &algorithm_;
    double lines_ = 0, area_ = 0;
    std::vector<double> times_;
};

} // namespace

std::vector<ResultRow> semicircleExperiment(const ExperimentOptions &options) {
    std::vector<ResultRow> rows;
    std::size_t done = 0;
    const double sigmas[] = {0.03, 0.003, 0.0003};
    for (const double sigma : sigmas)
        for (const std::size_t n :
             {20ul, 50ul, 100ul, 200ul, 500ul, 1000ul, 2000ul, 5000ul, 10000ul, 20000ul}) {
            if (options.progress)
                options.progress(++done, 10 * std::size(sigmas));
            if (n > options.maxPoints)
                continue;
            Cluster arc;
            for (std::size_t i = 0; i < n; ++i) {
                const double angle = vectorlib::pi * static_cast<double>(i) / static_cast<double>(n - 1);
                arc.emplace_back(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
            }
            for (const Algorithm &algorithm : comparedAlgorithms(sigma, false)) {
                Collector collector(algorithm);
                collector.take({arc}, {});
                rows.push_back(collector.row(sigma, n, 0));
            }
        }
    return rows;
}

std::vector<ResultRow> sceneExperiment(const Scene &scene, const ExperimentOptions &options) {
    const auto truth = scene.visible();
    std::vector<ResultRow> rows;
    std::size_t done = 0;
    for (const std::size_t n : pointCounts) {
        if (n > options.maxPoints)
            continue;
        const std::vector<Algorithm> algorithms = comparedAlgorithms(sceneSigma, true);
        std::vector<Collector> collectors(algorithms.begin(), algorithms.end());
        vectorlib::SimulatedScanner<float> scan(options.seed);
        scan.rays = static_cast<int>(n);
        scan.sigma = scannerNoise;
        for (int run = 0; run < options.runs; ++run) {
            const std::vector<Cluster> clusters = clustersOf(scan(scene.edges, {}), n);
            for (Collector &collector : collectors)
                collector.take(clusters, truth);
            if (options.progress)
                options.progress(++done, std::size(pointCounts) * static_cast<std::size_t>(options.runs));
        }
        for (const Collector &collector : collectors)
            rows.push_back(collector.row(sceneSigma, n, truth.size()));
    }
    return rows;
}

void writeCsv(std::ostream &out, const std::vector<ResultRow> &rows) {
    using vectorlib::Number;
    out << "sigma,points,algorithm,runs,lines_true,lines_found,lines_percent,area_m2,time_us\n";
    for (const ResultRow &r : rows)
        out << Number(r.sigma) << ',' << r.points << ',' << r.algorithm << ',' << r.runs << ','
            << Number(r.linesTrue) << ',' << Number(r.linesFound) << ',' << Number(r.linesPercent()) << ','
            << Number(r.area) << ',' << Number(r.microseconds) << '\n';
}

std::vector<Plot> plotsOf(const std::string &title, const std::vector<ResultRow> &rows) {
    const bool truth = !rows.empty() && rows.front().linesTrue > 0;
    std::vector<Plot> plots;
    const auto add = [&](const char *name, const char *axis, bool logarithmic, auto quantity) {
        Plot plot{name, title, "points", axis, true, logarithmic, {}};
        for (const Algorithm &algorithm : comparedAlgorithms(sceneSigma, false)) {
            Curve curve{algorithm.label, algorithm.colour, {}};
            for (const ResultRow &row : rows)
                if (row.algorithm == algorithm.label)
                    curve.points.emplace_back(row.points, quantity(row));
            if (!curve.points.empty())
                plot.curves.push_back(std::move(curve));
        }
        plots.push_back(std::move(plot));
    };
    add("time", "time a scan [us]", true, [](const ResultRow &r) { return r.microseconds; });
    if (truth) {
        add("lines", "additional lines [percent]", false,
            [](const ResultRow &r) { return r.linesPercent(); });
        add("area", "error area [m^2]", true, [](const ResultRow &r) { return r.area; });
    } else {
        add("lines", "lines", true, [](const ResultRow &r) { return r.linesFound; });
    }
    return plots;
}

} // namespace hermes::vector
