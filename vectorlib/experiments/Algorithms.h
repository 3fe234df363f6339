#pragma once

#include "gui/vector/Vectorizers.h"

namespace hermes::experiments {

using vector::Vectorize;

/// One of the vectorizers, chosen at run time.
struct Algorithm {
    std::string name;   ///< as the option --algorithm takes it
    std::string label;  ///< as papers write it
    std::string colour; ///< in plots, as in the thesis where it has one
    Vectorize<float> run;
};

/// Those that the experiments of thesis 6.5 compare, for a standard deviation sigma (metres) of points from
/// their line; those that eliminate points take 3 sigma as their distance.
std::vector<Algorithm> comparedAlgorithms(double sigma, bool polyline);
/// The same and their variants, for figures 6.8 to 6.10: AFTLS with the published search (AFTLS-NM), and
/// Reumann-Witkam by adjacent points (RW-adjacent).
std::vector<Algorithm> sceneAlgorithms(double sigma);
/// Those of comparedAlgorithms() for the comparison of polylines: split-and-merge twice, as published, where
/// every line keeps its own ends (SAM), and with our post-processing (SAM+).
std::vector<Algorithm> polylineExtractors(double sigma);

} // namespace hermes::experiments
