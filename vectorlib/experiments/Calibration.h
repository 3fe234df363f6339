#pragma once

#include "vectorlib/experiments/GlobalPairsExperiment.h"
#include "vectorlib/experiments/Plot.h"

#include <array>

namespace hermes::experiments {

/// Solutions whose probability was told to be in one tenth.
struct CalibrationTenth {
    std::size_t solutions = 0;
    double told = 0;  ///< mean probability; 0 of none
    double right = 0; ///< share within 10 cm and 2 degrees of the reference
};

using CalibrationTenths = std::array<CalibrationTenth, 10>;

/// Adds to the sums in the tenth of this probability; toMeans makes means and shares of them.
void add(CalibrationTenths &tenths, double probability, bool right);
void toMeans(CalibrationTenths &tenths);

/// How the probabilities that were told agree with what was right.
struct Calibration {
    CalibrationTenths best; ///< best solutions of pairs
    CalibrationTenths all;  ///< all solutions, the best ones among them
    /// What a fit to these pairs gives.
    vectorlib::MatchProbability fitted;
};

Calibration calibrationOf(const std::vector<GlobalPairResult> &pairs);

nlohmann::ordered_json summaryOf(const Calibration &calibration);
void writeCsv(std::ostream &out, const Calibration &calibration);
/// The reliability diagram: told probability against share right, of tenths with 20 solutions or more.
Plot plotOf(const Calibration &calibration);

} // namespace hermes::experiments
