#include "vectorlib/experiments/ExperimentCommand.h"

#include "vectorlib/experiments/BiasExperiment.h"
#include "vectorlib/experiments/RotationExperiment.h"
#include "vectorlib/experiments/SpaceExperiment.h"
#include "vectorlib/experiments/WeightingTables.h"

namespace hermes::experiments {

void ExperimentCommand::accuracy(OutputSet &files, std::ostream &csv) const {
    const auto rows = registrationExperiment(world("cutsquare"), scansOf(manyPoints, sigmas), options);
    writeCsv(csv, rows);
    draw(files, {accuracyPlots(rows), {}, {}});
}

void ExperimentCommand::dispersion(OutputSet &files, std::ostream &csv) const {
    const World square = world("cutsquare"), pillars = world("pillars");
    const RegistrationCase ofSquare = scansOf({100, 300, 1000}, sigmas), ofPillars = scansOf({300}, {0.05});
    ProgressParts parts(options.progress,
                        {stepsOf(square, ofSquare, options), stepsOf(pillars, ofPillars, options)});
    ExperimentOptions each = options;
    each.progress = parts.next();
    const auto rows = registrationExperiment(square, ofSquare, each);
    each.progress = parts.next();
    const auto hard = registrationExperiment(pillars, ofPillars, each);
    std::vector<RegistrationRow> all = rows;
    all.insert(all.end(), hard.begin(), hard.end());
    writeCsv(csv, all);
    constexpr double enlarged = 5; // times
    Figures figures;
    const auto show = [&](const World &world, const std::vector<RegistrationRow> &some,
                          const std::string &panel) {
        figures.plots.push_back(dispersionPlot(world, some, panel, 1));
        figures.plots.push_back(dispersionPlot(world, some, panel + "-enlarged", enlarged));
    };
    for (const auto &[panel, points, sigma] :
         {std::tuple{"a", 100, 0.1}, {"b", 300, 0.1}, {"c", 1000, 0.1}, {"d", 300, 0.03}, {"e", 300, 0.01}})
        show(square, select(rows, points, sigma, false), panel);
    show(pillars, select(hard, 300, 0.05, false), "f");
    show(pillars, select(hard, 300, 0.05, true), "f-weighted");
    draw(files, figures);
}

void ExperimentCommand::weighting(OutputSet &files, std::ostream &csv) const {
    const World places[] = {world("cutsquare"), world("oblique"), world("pillars")};
    const RegistrationCase which = scansOf(manyPoints, sigmas);
    std::vector<std::size_t> steps;
    for (const World &place : places)
        steps.push_back(stepsOf(place, which, options));
    ProgressParts parts(options.progress, steps);
    ExperimentOptions each = options;
    std::vector<RegistrationRow> rows;
    for (const World &place : places) {
        each.progress = parts.next();
        const auto some = registrationExperiment(place, which, each);
        rows.insert(rows.end(), some.begin(), some.end());
    }
    writeCsv(csv, rows);
    const std::vector<WeightingRow> tables = weightingRows(rows);
    writeCsv(open(files, "-tables.csv"), tables);
    draw(files, {weightingPlots(rows), {}, weightingTables(tables)});
}

void ExperimentCommand::reliability(OutputSet &files, std::ostream &csv) const {
    // Every pose sees two walls that are longer, but noise may cut one of them below it.
    constexpr double shortest = 2;
    const World pillars = world("pillars");
    const auto rows = registrationExperiment(pillars, scansOf({300}, {0.1}, shortest), options);
    writeCsv(csv, rows);
    draw(files, {{reliabilityPlot(pillars, select(rows, 300, 0.1, true))}, {}, {}});
}

void ExperimentCommand::registrationSpace(OutputSet &files, std::ostream &csv) const {
    const std::vector<RegistrationExample> examples{roomExample(), collinearExample(), directionsExample()};
    writeCsv(csv, examples);
    tell(open(files, ".json"), summaryOf(examples));
    draw(files, {{collinearPlot(examples[1]), reliabilityEllipse(examples[2])},
                 {},
                 {},
                 transformationSpace(examples[0])});
}

void ExperimentCommand::registrationBias(OutputSet &files, std::ostream &csv) const {
    const auto rows = biasExperiment(world("cutsquare"), scansOf(manyPoints, sigmas), options);
    writeCsv(csv, rows);
    draw(files, {plotsOf(rows), {}, {}});
}

RegistrationCase ExperimentCommand::scansOf(std::vector<int> points, std::vector<double> noises,
                                            double minLength) const {
    return {std::move(points), std::move(noises), minLength,
            knownEdges ? Pairing::KnownEdges : Pairing::Extracted};
}

void ExperimentCommand::rotation(OutputSet &files, std::ostream &csv) const {
    const std::vector<RotationRow> rows = rotationExperiment(options);
    writeCsv(csv, rows);
    draw(files, {{plotOf(rows)}, {}, {}});
}

std::vector<RegistrationRow> ExperimentCommand::select(const std::vector<RegistrationRow> &rows, int points,
                                                       double sigma, bool weighted) {
    std::vector<RegistrationRow> some;
    for (const RegistrationRow &row : rows)
        if (row.points == points && row.sigma == sigma && row.weighted == weighted)
            some.push_back(row);
    return some;
}

} // namespace hermes::experiments
