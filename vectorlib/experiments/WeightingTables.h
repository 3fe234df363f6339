#pragma once

#include "vectorlib/experiments/RegistrationExperiment.h"

namespace hermes::experiments {

/// What one world says about weighting and ambiguity.
struct WeightingRow {
    std::string world;
    /// Paper table 1: weighted over unweighted, each the mean over poses; geometric mean over the numbers of
    /// points and noises.
    double ratioAmbiguityXY = 0, ratioAmbiguityAlpha = 0, ratioErrorXY = 0, ratioErrorAlpha = 0;
    /// Paper table 2: Pearson correlation over poses of the mean ambiguity with the mean squared error, mean
    /// over the numbers of points and noises; without and with weights.
    double correlationXY = 0, correlationAlpha = 0, correlationXYWeighted = 0, correlationAlphaWeighted = 0;
};

/// A row for each world, in the order in which they first appear.
std::vector<WeightingRow> weightingRows(const std::vector<RegistrationRow> &rows);

void writeCsv(std::ostream &out, const std::vector<WeightingRow> &rows);
/// Both tables as in the paper, with its own figures beside ours.
std::vector<Table> weightingTables(const std::vector<WeightingRow> &rows);
/// The ratio of D_t and of D_alpha over the number of points, a curve for each world.
std::vector<Plot> weightingPlots(const std::vector<RegistrationRow> &rows);

} // namespace hermes::experiments
