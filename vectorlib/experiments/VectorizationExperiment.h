#pragma once

#include "gui/vector/ProgressParts.h"
#include "vectorlib/experiments/MeanBand.h"
#include "vectorlib/experiments/Plot.h"
#include "vectorlib/experiments/Scene.h"

namespace hermes::experiments {

using vector::ProgressParts;
using vector::ProgressSink;

/// One result: an algorithm on so many points.
struct ResultRow {
    double sigma = 0;        ///< permitted standard deviation of points from a line; metres
    std::size_t points = 0;  ///< rays of the scanner, or points of the cluster
    std::string algorithm;   ///< label
    int runs = 0;            ///< scans, each with noise of its own
    double linesTrue = 0;    ///< 0 where there is no true number
    MeanBand lines;          ///< found
    MeanBand area;           ///< error area; m^2
    double microseconds = 0; ///< median time of a scan, vectorization alone

    double percent(double found) const { return linesTrue > 0 ? 100 * (found / linesTrue - 1) : 0; }
};

struct ExperimentOptions {
    int runs = 20; ///< scans with noise of their own for each number of points
    std::size_t maxPoints = 20000;
    std::uint64_t seed = 1;
    double noise = 0.01; ///< of the range, standard deviation; metres
    ProgressSink progress;
};

/// The points of thesis figure 6.7a, evenly spaced on half a circle of radius 1 m; two or more.
std::vector<vectorlib::Vector2D<float>> semicircle(std::size_t count);
/// Thesis figure 6.7: a semicircle of radius 1 m without noise, for sigma 0.03, 0.003 and 0.0003 m.
std::vector<ResultRow> semicircleExperiment(const ExperimentOptions &options);
/// Figures 6.8 to 6.10: scans of a scene, segmented as in thesis 5.3, sigma 0.02 m. AFTLS also with the
/// published search, and after segmentation in polar coordinates (AFTLS-polar).
std::vector<ResultRow> sceneExperiment(const Scene &scene, const ExperimentOptions &options);

void writeCsv(std::ostream &out, const std::vector<ResultRow> &rows);
/// Time, lines (for each true one where the number is known) and error area (where there is one) over the
/// number of points, with the bands of their means.
std::vector<Plot> plotsOf(const std::string &title, const std::vector<ResultRow> &rows);
/// The table of additional lines in percent, as figures 6.8b to 6.10b have it.
Table lineTable(const std::string &title, const std::vector<ResultRow> &rows);

} // namespace hermes::experiments
