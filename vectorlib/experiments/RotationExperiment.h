#pragma once

#include "vectorlib/experiments/Plot.h"
#include "vectorlib/experiments/VectorizationExperiment.h"

namespace hermes::experiments {

/// How the mean rotation scatters about the truth when one pair of a set is turned at random; radians.
struct RotationRow {
    double noise = 0;   ///< largest turn; turns are uniform between -noise and noise
    double mitsuta = 0; ///< standard deviation of the result
    double wahba = 0;
};

/// Paper figure 10, with sets of three pairs of which one is turned, as in its example (4.5); noise up to pi,
/// 50 sets for each of options.runs.
std::vector<RotationRow> rotationExperiment(const ExperimentOptions &options);

void writeCsv(std::ostream &out, const std::vector<RotationRow> &rows);
Plot plotOf(const std::vector<RotationRow> &rows);

} // namespace hermes::experiments
