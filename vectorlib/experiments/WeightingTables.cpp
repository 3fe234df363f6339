#include "vectorlib/experiments/WeightingTables.h"

#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace hermes::experiments {

namespace {

using Quantity = double RegistrationStatistics::*;
using Rows = std::vector<const RegistrationRow *>;

/// The poses of one world at one setting, without and with weights.
struct Setting {
    Rows plain, weighted;
};
/// By number of points and noise.
using Settings = std::map<std::pair<int, double>, Setting>;

std::vector<std::pair<std::string, Settings>> byWorld(const std::vector<RegistrationRow> &rows) {
    std::vector<std::pair<std::string, Settings>> worlds;
    for (const RegistrationRow &row : rows) {
        if (row.result.runs == row.result.unsolved)
            continue;
        if (worlds.empty() || worlds.back().first != row.world)
            worlds.emplace_back(row.world, Settings());
        Setting &setting = worlds.back().second[{row.points, row.sigma}];
        (row.weighted ? setting.weighted : setting.plain).push_back(&row);
    }
    return worlds;
}

double meanOf(const Rows &rows, Quantity quantity) {
    double sum = 0;
    for (const RegistrationRow *row : rows)
        sum += row->result.*quantity;
    return rows.empty() ? 0 : sum / static_cast<double>(rows.size());
}

// Geometric mean of weighted over unweighted over the settings.
double ratio(const Settings &settings, Quantity quantity) {
    double sum = 0;
    int count = 0;
    for (const auto &[key, setting] : settings) {
        const double plain = meanOf(setting.plain, quantity), weighted = meanOf(setting.weighted, quantity);
        if (plain > 0 && weighted > 0) {
            sum += std::log(weighted / plain);
            ++count;
        }
    }
    return count ? std::exp(sum / count) : 0;
}

double pearson(const Rows &rows, Quantity a, Quantity b) {
    const double ma = meanOf(rows, a), mb = meanOf(rows, b);
    double aa = 0, ab = 0, bb = 0;
    for (const RegistrationRow *row : rows) {
        const double da = row->result.*a - ma, db = row->result.*b - mb;
        aa += da * da;
        ab += da * db;
        bb += db * db;
    }
    return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

double correlation(const Settings &settings, Rows Setting::*which, Quantity a, Quantity b) {
    double sum = 0;
    for (const auto &[key, setting] : settings)
        sum += pearson(setting.*which, a, b);
    return settings.empty() ? 0 : sum / static_cast<double>(settings.size());
}

std::string twoDigits(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

// Paper tables 1 and 2.
const WeightingRow *publishedOf(const std::string &world) {
    static const WeightingRow rows[] = {{"cutsquare", 0.68, 0.65, 0.58, 0.66, 0.90, 0.59, 0.91, 0.53},
                                        {"oblique", 0.46, 0.43, 0.25, 0.27, 0.91, 0.82, 0.80, 0.56},
                                        {"pillars", 0.27, 0.25, 0.07, 0.07, 0.77, 0.58, 0.74, 0.61}};
    const auto *found = std::find_if(std::begin(rows), std::end(rows),
                                     [&](const WeightingRow &r) { return r.world == world; });
    return found != std::end(rows) ? found : nullptr;
}

} // namespace

std::vector<WeightingRow> weightingRows(const std::vector<RegistrationRow> &rows) {
    using S = RegistrationStatistics;
    std::vector<WeightingRow> result;
    for (const auto &[world, s] : byWorld(rows))
        result.push_back({world, ratio(s, &S::ambiguityXY), ratio(s, &S::ambiguityAlpha),
                          ratio(s, &S::errorXY), ratio(s, &S::errorAlpha),
                          correlation(s, &Setting::plain, &S::ambiguityXY, &S::errorXY),
                          correlation(s, &Setting::plain, &S::ambiguityAlpha, &S::errorAlpha),
                          correlation(s, &Setting::weighted, &S::ambiguityXY, &S::errorXY),
                          correlation(s, &Setting::weighted, &S::ambiguityAlpha, &S::errorAlpha)});
    return result;
}

void writeCsv(std::ostream &out, const std::vector<WeightingRow> &rows) {
    using vectorlib::Number;
    out << "world,ratio_a_t,ratio_a_alpha,ratio_d_t,ratio_d_alpha,corr_t,corr_alpha,corr_t_weighted,"
           "corr_alpha_weighted\n";
    for (const WeightingRow &r : rows) {
        out << r.world;
        for (const double value :
             {r.ratioAmbiguityXY, r.ratioAmbiguityAlpha, r.ratioErrorXY, r.ratioErrorAlpha, r.correlationXY,
              r.correlationAlpha, r.correlationXYWeighted, r.correlationAlphaWeighted})
            out << ',' << Number(value);
        out << '\n';
    }
}

std::vector<Table> weightingTables(const std::vector<WeightingRow> &rows) {
    Table ratios{"Table 1: weighted over unweighted (lower is better)", {"Error metric"}, {}};
    Table correlations{"Table 2: correlation of ambiguity with squared error", {"Coefficient"}, {}};
    for (const WeightingRow &r : rows)
        for (Table *table : {&ratios, &correlations}) {
            table->header.push_back(r.world);
            table->header.emplace_back("published");
        }
    const auto add = [&](Table &table, const char *name, double WeightingRow::*quantity) {
        std::vector<std::string> cells{name};
        for (const WeightingRow &r : rows) {
            const WeightingRow *paper = publishedOf(r.world);
            cells.push_back(twoDigits(r.*quantity));
            cells.push_back(paper ? twoDigits(paper->*quantity) : "");
        }
        table.rows.push_back(cells);
    };
    add(ratios, "$A_t$", &WeightingRow::ratioAmbiguityXY);
    add(ratios, "$A_\\alpha$", &WeightingRow::ratioAmbiguityAlpha);
    add(ratios, "$D_t$", &WeightingRow::ratioErrorXY);
    add(ratios, "$D_\\alpha$", &WeightingRow::ratioErrorAlpha);
    add(correlations, "$Corr_t$", &WeightingRow::correlationXY);
    add(correlations, "$Corr_\\alpha$", &WeightingRow::correlationAlpha);
    add(correlations, "$Corr_{tw}$", &WeightingRow::correlationXYWeighted);
    add(correlations, "$Corr_{\\alpha w}$", &WeightingRow::correlationAlphaWeighted);
    return {ratios, correlations};
}

std::vector<Plot> weightingPlots(const std::vector<RegistrationRow> &rows) {
    std::vector<Plot> plots;
    const auto add = [&](const char *name, const char *axis, Quantity quantity) {
        Plot plot{name, "weighted over unweighted", "points", axis, true, true, {}};
        for (const auto &[world, settings] : byWorld(rows)) {
            std::map<int, Settings> byPoints;
            for (const auto &[key, setting] : settings)
                byPoints[key.first][key] = setting;
            Curve curve{world, vectorlib::colour::distinct(plot.curves.size()), {}};
            for (const auto &[points, some] : byPoints)
                curve.points.emplace_back(points, ratio(some, quantity));
            plot.curves.push_back(std::move(curve));
        }
        plots.push_back(std::move(plot));
    };
    add("position", "ratio of squared position errors", &RegistrationStatistics::errorXY);
    add("heading", "ratio of squared heading errors", &RegistrationStatistics::errorAlpha);
    return plots;
}

} // namespace hermes::experiments
