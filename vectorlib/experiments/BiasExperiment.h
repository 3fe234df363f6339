#pragma once

#include "vectorlib/experiments/RegistrationExperiment.h"

namespace hermes::experiments {

/// The squared errors of registration at one setting, means over the poses, parted into what is left when
/// many scans are averaged (bias) and the rest.
struct BiasRow {
    Pairing pairing = Pairing::Extracted;
    int points = 0;
    double sigma = 0; ///< metres
    bool weighted = false;
    double pairs = 0;                     ///< segments of a scan
    double errorXY = 0, biasXY = 0;       ///< m^2
    double errorAlpha = 0, biasAlpha = 0; ///< rad^2
};

/// Why the error of paper figure 6 does not fall with the number of points for ever: the same scans with
/// segments made in every way of Pairing.
std::vector<BiasRow> biasExperiment(const World &world, const RegistrationCase &which,
                                    const ExperimentOptions &options);
void writeCsv(std::ostream &out, const std::vector<BiasRow> &rows);
/// Errors and their biases over the number of points, without weights, for the largest noise.
std::vector<Plot> plotsOf(const std::vector<BiasRow> &rows);

} // namespace hermes::experiments
