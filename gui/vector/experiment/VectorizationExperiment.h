#pragma once

#include "gui/vector/experiment/Scene.h"
#include "gui/vector/experiment/Table.h"

#include <functional>

namespace hermes {

struct ExperimentOptions {
    int runs = 20; ///< scans with noise of their own for each number of points
    std::size_t maxPoints = 20000;
    std::uint64_t seed = 1;
    std::function<void(std::size_t done, std::size_t all)> progress;
};

/// Thesis figure 6.7: a semicircle of radius 1 m without noise, for sigma 0.03, 0.003 and 0.0003 m.
std::vector<ResultRow> semicircleExperiment(const ExperimentOptions &options);
/// Figures 6.8 to 6.10: scans of a scene with noise of 1 cm, segmented as in thesis 5.3, sigma 0.02 m.
std::vector<ResultRow> sceneExperiment(const Scene &scene, const ExperimentOptions &options);

} // namespace hermes
