#pragma once

#include "vectorlib/experiments/Plot.h"
#include "vectorlib/experiments/QualityScan.h"
#include "vectorlib/experiments/VectorizationExperiment.h"

namespace hermes::experiments {

/// How well an extractor does with so many vertices: the measures of Schaefer et al., 2018 at equal J. Means
/// over the scans of which every extractor makes polylines of at most J vertices.
struct QualityRow {
    int verticesTrue = 0;   ///< of the polygon; 0 for all polygons together and for real scans
    std::size_t budget = 0; ///< J: of each scan the extraction with the most vertices up to this counts
    std::string algorithm;  ///< label
    int scans = 0;
    double sigma = 0;    ///< that the extraction took; metres
    double vertices = 0; ///< that it used
    double rmse = 0;     ///< see QualityMeasures
    double hitShare = 0;
    double areaError = 0;
};

/// Random closed polygons of 6 to 180 vertices around the scanner, as many of each kind as there are runs;
/// then all of them together, as the paper shows them.
std::vector<QualityRow> polygonExperiment(const ExperimentOptions &options);
/// The scans of a log, ten times as many as there are runs, spread over the log.
std::vector<QualityRow> logExperiment(const std::vector<vectorlib::CarmenScan> &scans,
                                      const ExperimentOptions &options);

void writeCsv(std::ostream &out, const std::vector<QualityRow> &rows);
/// RMSE, hit share and (for polygons) area error over J: a set of plots for each number of true vertices, and
/// one for all, which has the title.
std::vector<Plot> plotsOf(const std::string &title, const std::vector<QualityRow> &rows);

} // namespace hermes::experiments
