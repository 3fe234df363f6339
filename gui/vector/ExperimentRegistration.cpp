#include "gui/vector/ExperimentCommand.h"

#include "gui/vector/experiment/RotationExperiment.h"
#include "gui/vector/experiment/WeightingTables.h"

namespace hermes::vector {

void ExperimentCommand::accuracy(OutputSet &files, std::ostream &csv) const {
    const auto rows = registrationExperiment(world("cutsquare"), {manyPoints, sigmas, 0}, options);
    writeCsv(csv, rows);
    draw(files, {accuracyPlots(rows), {}, {}});
}

void ExperimentCommand::dispersion(OutputSet &files, std::ostream &csv) const {
    const World square = world("cutsquare"), pillars = world("pillars");
    const auto rows = registrationExperiment(square, {{100, 300, 1000}, sigmas, 0}, options);
    const auto hard = registrationExperiment(pillars, {{300}, {0.05}, 0}, options);
    std::vector<RegistrationRow> all = rows;
    all.insert(all.end(), hard.begin(), hard.end());
    writeCsv(csv, all);
    constexpr double scale = 5; // of the ellipses
    Figures figures;
    for (const auto &[panel, points, sigma] :
         {std::tuple{"a", 100, 0.1}, {"b", 300, 0.1}, {"c", 1000, 0.1}, {"d", 300, 0.03}, {"e", 300, 0.01}})
        figures.plots.push_back(dispersionPlot(square, select(rows, points, sigma, false), panel, scale));
    figures.plots.push_back(dispersionPlot(pillars, select(hard, 300, 0.05, false), "f", scale));
    figures.plots.push_back(dispersionPlot(pillars, select(hard, 300, 0.05, true), "f-weighted", scale));
    draw(files, figures);
}

void ExperimentCommand::weighting(OutputSet &files, std::ostream &csv) const {
    std::vector<RegistrationRow> rows;
    for (const char *place : {"cutsquare", "oblique", "pillars"}) {
        const auto some = registrationExperiment(world(place), {manyPoints, sigmas, 0}, options);
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
    const auto rows = registrationExperiment(pillars, {{300}, {0.1}, shortest}, options);
    writeCsv(csv, rows);
    draw(files, {{reliabilityPlot(pillars, select(rows, 300, 0.1, true))}, {}, {}});
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

} // namespace hermes::vector
