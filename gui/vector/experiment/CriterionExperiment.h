#pragma once

#include "gui/vector/experiment/Plot.h"
#include "gui/vector/experiment/VectorizationExperiment.h"

namespace hermes::vector {

/// Thesis figures 7.3 to 7.6: the area criterion of the segment from (0, 0) to (1, 0) m and a second one,
/// m^4: shifted along it and then turned; scaled and turned; turned and then shifted; scaled, turned by 45
/// degrees and shifted.
std::vector<Surface> criterionSurfaces();

/// How long the criterion takes for so many pairs and transformations; microseconds.
struct CriterionTime {
    std::size_t pairs = 0;
    std::size_t transformations = 0;
    double pairByPair = 0; ///< (7.16) and (7.17) for each pair and transformation
    double fromSums = 0;   ///< the sums are made, then (7.18) for each transformation

    double speedUp() const { return pairByPair / fromSums; }
};

/// Thesis figures 7.7 to 7.9: 1 to 1,000 pairs by 1 to 1,000 transformations.
std::vector<CriterionTime> criterionTimes(const ExperimentOptions &options);

void writeCsv(std::ostream &out, const std::vector<Surface> &surfaces);
void writeCsv(std::ostream &out, const std::vector<CriterionTime> &times);
std::vector<Plot> plotsOf(const std::vector<CriterionTime> &times);

} // namespace hermes::vector
