#pragma once

#include "vectorlib/experiments/VectorizationExperiment.h"

#include "vectorlib/io/Svg.h"

namespace hermes::experiments {

/// Thesis figure 6.7a: the semicircle with 100 points.
vectorlib::SvgPicture pictureOfSemicircle();
/// Figures 6.8a to 6.10a: a scan of the scene, the true edges and the scanner.
vectorlib::SvgPicture pictureOfCloud(const Scene &scene, const ExperimentOptions &options);

} // namespace hermes::experiments
