#include "vectorlib/experiments/VectorizationExperiment.h"

#include "gui/vector/Quantile.h"
#include "vectorlib/experiments/Algorithms.h"
#include "vectorlib/experiments/Timing.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/observation/SimulatedScanner.h"
#include "vectorlib/segmentation/EarSegmenter.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace hermes::experiments {

using vector::median;

namespace {

using Point = vectorlib::Vector2D<float>;
using Cluster = std::vector<Point>;

constexpr std::size_t pointCounts[] = {200, 500, 1000, 2000, 5000, 10000, 20000};
constexpr double sceneSigma = 0.02; // metres

using Coordinates = vectorlib::EarSettings::Coordinates;

std::vector<Cluster> clustersOf(const std::vector<Point> &scan, std::size_t rays, Coordinates coordinates) {
    vectorlib::EarSegmenter<float> segment;
    segment.settings.nominalPoints = rays;
    segment.settings.coordinates = coordinates;
    const vectorlib::Segmentation &found = segment(scan);
    std::vector<Cluster> clusters(found.size());
    for (std::size_t c = 0; c < found.size(); ++c)
        for (std::size_t i = found.starts[c]; i < found.starts[c + 1]; ++i)
            clusters[c].push_back(scan[static_cast<std::size_t>(found.order[i])]);
    return clusters;
}

/// Beside that of scans of other numbers of points, about: measuring takes its time in any case.
std::size_t timeOfScan(std::size_t points) {
    return 20 + points / 1000;
}

/// An algorithm behind segmentation in the coordinates.
struct Contender : Algorithm {
    Coordinates coordinates = Coordinates::Cartesian;
};

std::vector<Contender> sceneContenders() {
    std::vector<Contender> all;
    for (const Algorithm &algorithm : sceneAlgorithms(sceneSigma))
        all.push_back({algorithm, Coordinates::Cartesian});
    all.push_back({all.front(), Coordinates::Polar});
    all.back().label += "-polar";
    all.back().colour = "#a0522d";
    return all;
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
        lines_.push_back(static_cast<double>(found.size()));
        areas_.push_back(truth.empty() ? 0 : errorArea(truth, found));
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
        r.lines = MeanBand::of(lines_);
        r.area = MeanBand::of(areas_);
        r.microseconds = median(times_);
        return r;
    }

private:
    const Algorithm &algorithm_;
    std::vector<double> lines_, areas_, times_;
};

} // namespace

std::vector<Point> semicircle(std::size_t count) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = vectorlib::pi * static_cast<double>(i) / static_cast<double>(count - 1);
        points.emplace_back(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
    }
    return points;
}

std::vector<ResultRow> semicircleExperiment(const ExperimentOptions &options) {
    constexpr std::size_t counts[] = {20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000};
    constexpr double sigmas[] = {0.03, 0.003, 0.0003};
    std::vector<ResultRow> rows;
    const auto most = std::upper_bound(std::begin(counts), std::end(counts), options.maxPoints);
    const std::size_t all = std::size(sigmas) * static_cast<std::size_t>(most - std::begin(counts));
    std::size_t done = 0;
    for (const double sigma : sigmas)
        for (const std::size_t n : counts) {
            if (n > options.maxPoints)
                continue;
            const Cluster arc = semicircle(n);
            for (const Algorithm &algorithm : comparedAlgorithms(sigma, false)) {
                Collector collector(algorithm);
                collector.take({arc}, {});
                rows.push_back(collector.row(sigma, n, 0));
            }
            if (options.progress)
                options.progress(++done, all);
        }
    return rows;
}

std::vector<ResultRow> sceneExperiment(const Scene &scene, const ExperimentOptions &options) {
    const auto truth = scene.visible();
    std::vector<ResultRow> rows;
    std::size_t done = 0, all = 0;
    for (const std::size_t n : pointCounts)
        all += n > options.maxPoints ? 0 : timeOfScan(n) * static_cast<std::size_t>(options.runs);
    for (const std::size_t n : pointCounts) {
        if (n > options.maxPoints)
            continue;
        const std::vector<Contender> contenders = sceneContenders();
        std::vector<Collector> collectors(contenders.begin(), contenders.end());
        vectorlib::SimulatedScanner<float> scanner(options.seed);
        scanner.rays = static_cast<int>(n);
        scanner.sigma = options.noise;
        for (int run = 0; run < options.runs; ++run) {
            const std::vector<Point> &scan = scanner(scene.edges, {});
            const std::vector<Cluster> cartesian = clustersOf(scan, n, Coordinates::Cartesian),
                                       polar = clustersOf(scan, n, Coordinates::Polar);
            for (std::size_t c = 0; c < contenders.size(); ++c)
                collectors[c].take(contenders[c].coordinates == Coordinates::Polar ? polar : cartesian,
                                   truth);
            if (options.progress)
                options.progress(done += timeOfScan(n), all);
        }
        for (const Collector &collector : collectors)
            rows.push_back(collector.row(sceneSigma, n, truth.size()));
    }
    return rows;
}

void writeCsv(std::ostream &out, const std::vector<ResultRow> &rows) {
    using vectorlib::Number;
    out << "sigma,points,algorithm,runs,lines_true,lines_found,lines_percent,lines_low,lines_high,area_m2,"
           "area_low_m2,area_high_m2,time_us\n";
    for (const ResultRow &r : rows)
        out << Number(r.sigma) << ',' << r.points << ',' << r.algorithm << ',' << r.runs << ','
            << Number(r.linesTrue) << ',' << Number(r.lines.mean) << ',' << Number(r.percent(r.lines.mean))
            << ',' << Number(r.lines.low) << ',' << Number(r.lines.high) << ',' << Number(r.area.mean) << ','
            << Number(r.area.low) << ',' << Number(r.area.high) << ',' << Number(r.microseconds) << '\n';
}

std::vector<Plot> plotsOf(const std::string &title, const std::vector<ResultRow> &rows) {
    const bool truth = !rows.empty() && rows.front().linesTrue > 0;
    std::vector<Plot> plots;
    const auto add = [&](const char *name, const char *axis, auto quantity) {
        Plot plot{name, title, "points", axis, true, true, {}};
        std::vector<Contender> contenders = sceneContenders();
        std::reverse(contenders.begin(), contenders.end()); // where they coincide the first is seen
        for (const Contender &contender : contenders) {
            Curve curve{contender.label, contender.colour, {}};
            for (const ResultRow &row : rows) {
                if (row.algorithm != contender.label)
                    continue;
                const MeanBand band = quantity(row);
                curve.points.emplace_back(row.points, band.mean);
                curve.band.emplace_back(band.low, band.high);
            }
            if (!curve.points.empty())
                plot.curves.push_back(std::move(curve));
        }
        plots.push_back(std::move(plot));
    };
    add("time", "time a scan [us]", [](const ResultRow &r) {
        return MeanBand{r.microseconds, r.microseconds, r.microseconds};
    });
    if (truth) {
        add("lines", "lines found / true lines", [](const ResultRow &r) {
            return MeanBand{r.lines.mean / r.linesTrue, r.lines.low / r.linesTrue,
                            r.lines.high / r.linesTrue};
        });
        add("area", "error area [m^2]", [](const ResultRow &r) { return r.area; });
    } else {
        add("lines", "lines", [](const ResultRow &r) { return r.lines; });
    }
    return plots;
}

Table lineTable(const std::string &title, const std::vector<ResultRow> &rows) {
    Table table{title + ": additional lines in percent", {"points", "lines"}, {}};
    for (const ResultRow &row : rows) {
        if (row.points == rows.front().points)
            table.header.push_back(row.algorithm);
        const std::string points = std::to_string(row.points);
        if (table.rows.empty() || table.rows.back().front() != points)
            table.rows.push_back({points, std::to_string(std::lround(row.linesTrue))});
        std::ostringstream cell;
        cell << std::showpos << std::fixed << std::setprecision(1) << row.percent(row.lines.mean);
        table.rows.back().push_back(cell.str());
    }
    return table;
}

} // namespace hermes::experiments
