#pragma once

#include "gui/vector/experiment/VectorizationExperiment.h"

#include <ostream>

namespace hermes::vector {

/// Thesis figure 6.7a: the semicircle with 100 points.
void drawSemicircle(std::ostream &svg);
/// Figures 6.8a to 6.10a: a scan of the scene, the true edges and the scanner.
void drawCloud(std::ostream &svg, const Scene &scene, const ExperimentOptions &options);

} // namespace hermes::vector
