#pragma once

#include "gui/vector/experiment/Plot.h"
#include "gui/vector/experiment/VectorizationExperiment.h"
#include "vectorlib/io/CarmenScan.h"

namespace hermes {

/// How well polylines stand for the rays of a scan, against the number of their vertices: the measures of
/// Schaefer et al., 2018. Means over scans.
struct QualityRow {
    int verticesTrue = 0;  ///< of the polygon; 0 for real scans
    std::string algorithm; ///< label
    double sigma = 0;      ///< permitted standard deviation of points from a line; metres
    double vertices = 0;   ///< J
    double rmse = 0;       ///< of the measured ranges from the polylines, rays that hit; metres
    double hitShare = 0;   ///< f, of the rays
    double areaError = 0; ///< a, area between true and extracted polygon over the true area; 0 for real scans
};

/// Random closed polygons of 6 to 180 vertices around the scanner, 360 rays, noise 2 cm; every extractor at
/// several sigma.
std::vector<QualityRow> polygonExperiment(const ExperimentOptions &options);
/// The same for the scans of a log.
std::vector<QualityRow> logExperiment(const std::vector<vectorlib::CarmenScan> &scans,
                                      const ExperimentOptions &options);

void writeCsv(std::ostream &out, const std::vector<QualityRow> &rows);
/// RMSE, hit share and (for polygons) area error over J, a set of plots for each number of true vertices.
std::vector<Plot> plotsOf(const std::vector<QualityRow> &rows);

} // namespace hermes
