#pragma once

#include "vectorlib/experiments/report/Drawing.h"

#include <cstdint>

namespace hermes::experiments {

/// A picture of a stage of the correspondence search.
struct SearchFigure {
    std::string name;  ///< in file names
    std::string title; ///< with the figure of the thesis
    Drawing drawing;
    std::vector<Ink> inks;
};

/// Thesis figures 7.16 (two scans), 7.17 (potential pairs by three accuracies), 7.18 (bundles of each bucket
/// in colours), 7.19 (expected view) and 7.20 (discrepancy of the correct and of a wrong set of
/// correspondences).
std::vector<SearchFigure> searchFigures(std::uint64_t seed);

void writeSvg(std::ostream &out, const SearchFigure &figure);
/// A document that pdflatex compiles.
void writeLatex(std::ostream &out, const std::vector<SearchFigure> &figures);

} // namespace hermes::experiments
