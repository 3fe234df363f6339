#include "vectorlib/experiments/QualityExperiment.h"

#include "vectorlib/experiments/Algorithms.h"
#include "vectorlib/io/Number.h"

#include <algorithm>
#include <map>

namespace hermes::experiments {

namespace {

constexpr int polygonVertices[] = {6, 12, 36, 90, 180};
// J: the paper has them up to 50; with one vertex for every second ray polylines show the noise.
constexpr std::size_t budgets[] = {10, 20, 30, 40, 50, 100, 180};

// From 1 mm to 2 m in steps of a tenth.
std::vector<double> sweptSigmas() {
    std::vector<double> sigmas;
    for (double sigma = 0.001; sigma < 2; sigma *= 1.1)
        sigmas.push_back(sigma);
    return sigmas;
}

/// What an algorithm makes of a scan: a polyline for each cluster.
struct Extraction {
    double sigma = 0;
    std::size_t vertices = 0;
    std::vector<Edges> polylines;
};

Extraction extract(const Algorithm &algorithm, double sigma, const QualityScan &scan) {
    Extraction extraction{sigma, 0, {}};
    for (const QualityCluster &cluster : scan) {
        extraction.polylines.emplace_back();
        for (const vectorlib::VectorizedLine &line : algorithm.run(cluster.points))
            if (line.segment.isFinite())
                extraction.polylines.back().push_back(line.segment);
        extraction.vertices += countVertices(extraction.polylines.back());
    }
    return extraction;
}

/// Compares the algorithms at equal J over scans.
class EqualVertices {
public:
    EqualVertices() {
        for (const double sigma : sigmas_)
            algorithms_.push_back(polylineExtractors(sigma));
    }
    void take(const QualityScan &scan) {
        const std::size_t algorithms = algorithms_.front().size();
        std::vector<std::vector<Extraction>> best; // by algorithm and budget
        for (std::size_t a = 0; a < algorithms; ++a)
            best.push_back(extractions(a, scan));
        for (std::size_t j = 0; j < std::size(budgets); ++j) {
            bool comparable = true;
            for (const auto &b : best)
                comparable = comparable && b[j].vertices > 0;
            for (std::size_t a = 0; comparable && a < algorithms; ++a)
                add(rows_[{j, a}], best[a][j], scan);
        }
    }
    void append(std::vector<QualityRow> &rows, int verticesTrue) const {
        for (const auto &[key, sum] : rows_) {
            QualityRow row = sum;
            row.verticesTrue = verticesTrue;
            row.budget = budgets[key.first];
            row.algorithm = algorithms_.front()[key.second].label;
            for (double *mean : {&row.sigma, &row.vertices, &row.rmse, &row.hitShare, &row.areaError})
                *mean /= row.scans;
            rows.push_back(row);
        }
    }

private:
    // Of all sigmas the one that gives the most vertices up to each budget; of several the smallest.
    std::vector<Extraction> extractions(std::size_t algorithm, const QualityScan &scan) const {
        std::vector<Extraction> best(std::size(budgets));
        for (std::size_t s = 0; s < sigmas_.size(); ++s) {
            const Extraction extraction = extract(algorithms_[s][algorithm], sigmas_[s], scan);
            for (std::size_t j = 0; j < best.size(); ++j)
                if (extraction.vertices <= budgets[j] && extraction.vertices > best[j].vertices)
                    best[j] = extraction;
        }
        return best;
    }
    static void add(QualityRow &row, const Extraction &extraction, const QualityScan &scan) {
        QualityMeasures measures;
        for (std::size_t c = 0; c < scan.size(); ++c)
            measures.take(scan[c], extraction.polylines[c]);
        ++row.scans;
        row.sigma += extraction.sigma;
        row.vertices += static_cast<double>(extraction.vertices);
        row.rmse += measures.rmse();
        row.hitShare += measures.hitShare();
        row.areaError += measures.areaError();
    }

    const std::vector<double> sigmas_ = sweptSigmas();
    std::vector<std::vector<Algorithm>> algorithms_;                 // by sigma
    std::map<std::pair<std::size_t, std::size_t>, QualityRow> rows_; // by budget and algorithm; sums
};

// Means over all kinds of polygons, by J and algorithm.
std::vector<QualityRow> together(const std::vector<QualityRow> &rows) {
    std::vector<QualityRow> all;
    for (const QualityRow &row : rows) {
        auto found = std::find_if(all.begin(), all.end(), [&row](const QualityRow &a) {
            return a.budget == row.budget && a.algorithm == row.algorithm;
        });
        if (found == all.end()) {
            found = all.insert(all.end(), QualityRow());
            found->budget = row.budget;
            found->algorithm = row.algorithm;
        }
        found->scans += row.scans;
        const double share = static_cast<double>(row.scans) / found->scans;
        const auto average = [share](double &mean, double value) { mean += share * (value - mean); };
        average(found->sigma, row.sigma);
        average(found->vertices, row.vertices);
        average(found->rmse, row.rmse);
        average(found->hitShare, row.hitShare);
        average(found->areaError, row.areaError);
    }
    return all;
}

} // namespace

std::vector<QualityRow> polygonExperiment(const ExperimentOptions &options) {
    std::vector<QualityRow> rows;
    std::mt19937_64 random(options.seed);
    std::size_t done = 0;
    for (const int vertices : polygonVertices) {
        EqualVertices compare;
        for (int run = 0; run < options.runs; ++run) {
            compare.take(polygonScan(vertices, random));
            if (options.progress)
                options.progress(++done, std::size(polygonVertices) * static_cast<std::size_t>(options.runs));
        }
        compare.append(rows, vertices);
    }
    const std::vector<QualityRow> all = together(rows);
    rows.insert(rows.end(), all.begin(), all.end());
    return rows;
}

std::vector<QualityRow> logExperiment(const std::vector<vectorlib::CarmenScan> &scans,
                                      const ExperimentOptions &options) {
    EqualVertices compare;
    const std::size_t step =
        std::max<std::size_t>(1, scans.size() / static_cast<std::size_t>(10 * options.runs));
    for (std::size_t i = 0; i < scans.size(); i += step) {
        compare.take(logScan(scans[i]));
        if (options.progress)
            options.progress(std::min(i + step, scans.size()), scans.size());
    }
    std::vector<QualityRow> rows;
    compare.append(rows, 0);
    return rows;
}

void writeCsv(std::ostream &out, const std::vector<QualityRow> &rows) {
    using vectorlib::Number;
    out << "vertices_true,budget,algorithm,scans,sigma,vertices,rmse,hit_share,area_error\n";
    for (const QualityRow &r : rows)
        out << r.verticesTrue << ',' << r.budget << ',' << r.algorithm << ',' << r.scans << ','
            << Number(r.sigma) << ',' << Number(r.vertices) << ',' << Number(r.rmse) << ','
            << Number(r.hitShare) << ',' << Number(r.areaError) << '\n';
}

std::vector<Plot> plotsOf(const std::string &title, const std::vector<QualityRow> &rows) {
    std::map<int, std::vector<QualityRow>> byPolygon;
    for (const QualityRow &row : rows)
        byPolygon[row.verticesTrue].push_back(row);
    std::vector<Plot> plots;
    for (const auto &[vertices, some] : byPolygon) {
        const std::string what = vertices ? "polygons of " + std::to_string(vertices) + " vertices" : title;
        const std::string prefix = vertices ? std::to_string(vertices) + "-" : "";
        const auto add = [&, &some = some](const char *name, const char *axis, bool logarithmic,
                                           double QualityRow::*measure) {
            Plot plot{prefix + name, what, "vertices J", axis, true, logarithmic, {}};
            for (const Algorithm &algorithm : polylineExtractors(1)) {
                Curve curve{algorithm.label, algorithm.colour, {}};
                for (const QualityRow &row : some)
                    if (row.algorithm == algorithm.label)
                        curve.points.emplace_back(row.budget, row.*measure);
                plot.curves.push_back(std::move(curve));
            }
            plots.push_back(std::move(plot));
        };
        add("rmse", "RMSE [m]", true, &QualityRow::rmse);
        add("hits", "share of rays that hit", false, &QualityRow::hitShare);
        if (some.front().areaError > 0)
            add("area", "relative area error", true, &QualityRow::areaError);
    }
    return plots;
}

} // namespace hermes::experiments
