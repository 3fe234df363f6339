#pragma once

#include "gui/vector/ProgressParts.h"
#include "vectorlib/experiments/Plot.h"
#include "vectorlib/geometry/LineSegment2D.h"

#include <cstdint>
#include <nlohmann/json.hpp>

namespace hermes::experiments {

using vector::ProgressParts;
using vector::ProgressSink;

/// A measure of how unlike two segments are.
struct SegmentCriterion {
    const char *name;  ///< in file names
    const char *title; ///< with its equation
    const char *unit;
    double (*of)(const vectorlib::LineSegment2D<double> &fixed,
                 const vectorlib::LineSegment2D<double> &moving);
    bool isSquared; ///< made to be summed as it is; one that is not is squared first
};

/// The area criterion, the quadrangle of the overview paper, and the three distances of thesis 7.1.4.
const std::vector<SegmentCriterion> &segmentCriteria();

/// In how many of the trials a criterion had a property that thesis 7.1.4 to 7.2.4 asks for.
struct CriterionProperty {
    std::string what;
    std::string source;
    std::vector<double> shares; ///< of segmentCriteria(), in [0, 1]; 1 where it was never contradicted
};

/// Each property tried with random segments.
std::vector<CriterionProperty> criterionProperties(std::uint64_t seed, int trials,
                                                   const ProgressSink &progress = {});

Table tableOf(const std::vector<CriterionProperty> &properties);
nlohmann::ordered_json summaryOf(const std::vector<CriterionProperty> &properties);

} // namespace hermes::experiments
