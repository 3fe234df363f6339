#pragma once

#include "vectorlib/experiments/CriterionProperties.h"
#include "vectorlib/experiments/Plot.h"
#include "vectorlib/experiments/VectorizationExperiment.h"

namespace hermes::experiments {

/// Thesis figures 7.3 to 7.6: a criterion of the segment from (0, 0) to (1, 0) m and a second one: shifted
/// along it and then turned; scaled and turned, also where it is short; turned and then shifted; scaled,
/// turned by 45 degrees and shifted.
std::vector<Surface> criterionSurfaces(const SegmentCriterion &criterion);

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

/// How many transformations of so many pairs take as long pair by pair as from sums; 0 where none of those
/// measured does.
struct BreakEven {
    std::size_t pairs = 0;
    double transformations = 0;
};
std::vector<BreakEven> breakEvens(const std::vector<CriterionTime> &times);
nlohmann::ordered_json summaryOf(const std::vector<CriterionTime> &times);

/// `value` names the column of the criterion.
void writeCsv(std::ostream &out, const std::vector<Surface> &surfaces, const std::string &value);
void writeCsv(std::ostream &out, const std::vector<CriterionTime> &times);
std::vector<Plot> plotsOf(const std::vector<CriterionTime> &times);

} // namespace hermes::experiments
