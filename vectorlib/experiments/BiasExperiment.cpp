#include "vectorlib/experiments/BiasExperiment.h"

#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"

#include <algorithm>

namespace hermes::experiments {

namespace {

struct NamedPairing {
    Pairing pairing;
    const char *name;  ///< in the table
    const char *label; ///< in the legend
};

constexpr NamedPairing pairings[] = {
    {Pairing::Extracted, "extracted", "extracted lines"},
    {Pairing::ExtractedTight, "extracted-tight", "extracted, sigma 1.2 times the noise"},
    {Pairing::ExtractedFtls, "extracted-ftls", "extracted by FTLS"},
    {Pairing::ExtractedClean, "extracted-clean", "extracted, no points of other edges"},
    {Pairing::KnownEdges, "known-edges", "rays that know their edge"},
    {Pairing::AcrossEdges, "across-edges", "... noise across the edge only"},
    {Pairing::FittedRanges, "fitted-ranges", "... lines fitted to ranges"},
};

std::vector<BiasRow> meansOverPoses(const std::vector<RegistrationRow> &rows, Pairing pairing) {
    std::vector<BiasRow> means;
    std::vector<int> counts;
    for (const RegistrationRow &row : rows) {
        const auto same = [&](const BiasRow &m) {
            return m.points == row.points && m.sigma == row.sigma && m.weighted == row.weighted;
        };
        auto at = std::find_if(means.begin(), means.end(), same);
        if (at == means.end()) {
            means.push_back({pairing, row.points, row.sigma, row.weighted});
            counts.push_back(0);
            at = means.end() - 1;
        }
        ++counts[std::size_t(at - means.begin())];
        at->pairs += row.result.pairs;
        at->errorXY += row.result.errorXY;
        at->biasXY += row.result.biasXY();
        at->errorAlpha += row.result.errorAlpha;
        at->biasAlpha += row.result.biasAlpha();
    }
    for (std::size_t i = 0; i < means.size(); ++i)
        for (double *sum : {&means[i].pairs, &means[i].errorXY, &means[i].biasXY, &means[i].errorAlpha,
                            &means[i].biasAlpha})
            *sum /= counts[i];
    return means;
}

Plot plotOf(const std::vector<BiasRow> &rows, const char *name, const char *title, const char *axis,
            double BiasRow::*value) {
    double sigma = 0;
    for (const BiasRow &row : rows)
        sigma = std::max(sigma, row.sigma);
    Plot plot{name,     title + std::string(", noise ") + std::to_string(std::lround(100 * sigma)) + " cm",
              "points", axis,
              true,     true,
              {}};
    for (const NamedPairing &p : pairings) {
        Curve curve{p.label, vectorlib::colour::distinct(plot.curves.size()), {}};
        for (const BiasRow &row : rows)
            if (row.pairing == p.pairing && row.sigma == sigma && !row.weighted)
                curve.points.emplace_back(row.points, row.*value);
        plot.curves.push_back(std::move(curve));
    }
    return plot;
}

} // namespace

std::vector<BiasRow> biasExperiment(const World &world, const RegistrationCase &which,
                                    const ExperimentOptions &options) {
    std::vector<BiasRow> rows;
    ProgressParts parts(options.progress,
                        std::vector<std::size_t>(std::size(pairings), stepsOf(world, which, options)));
    ExperimentOptions each = options;
    for (const NamedPairing &p : pairings) {
        each.progress = parts.next();
        RegistrationCase some = which;
        some.pairing = p.pairing;
        const std::vector<BiasRow> means =
            meansOverPoses(registrationExperiment(world, some, each), p.pairing);
        rows.insert(rows.end(), means.begin(), means.end());
    }
    return rows;
}

void writeCsv(std::ostream &out, const std::vector<BiasRow> &rows) {
    using vectorlib::Number;
    out << "segments,points,sigma,weighted,pairs,d_t,bias_t,d_alpha,bias_alpha\n";
    for (const BiasRow &row : rows) {
        const auto named = std::find_if(std::begin(pairings), std::end(pairings),
                                        [&](const NamedPairing &p) { return p.pairing == row.pairing; });
        out << named->name << ',' << row.points << ',' << Number(row.sigma) << ',' << row.weighted;
        for (const double value : {row.pairs, row.errorXY, row.biasXY, row.errorAlpha, row.biasAlpha})
            out << ',' << Number(value);
        out << '\n';
    }
}

std::vector<Plot> plotsOf(const std::vector<BiasRow> &rows) {
    return {plotOf(rows, "position", "squared error of the position", "m^2", &BiasRow::errorXY),
            plotOf(rows, "position-bias", "its part that averaging leaves", "m^2", &BiasRow::biasXY),
            plotOf(rows, "heading", "squared error of the heading", "rad^2", &BiasRow::errorAlpha),
            plotOf(rows, "heading-bias", "its part that averaging leaves", "rad^2", &BiasRow::biasAlpha)};
}

} // namespace hermes::experiments
