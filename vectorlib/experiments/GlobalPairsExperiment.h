#pragma once

#include "vectorlib/experiments/PairsExperiment.h"
#include "vectorlib/mapping/GlobalPairMatcher.h"

namespace hermes::experiments {

/// A pair, matched by nothing but the two scans.
struct GlobalPairResult : LogPair {
    vectorlib::GlobalPairMatch match;
    double microseconds = 0; ///< of the processor, from the points of both scans to the solutions

    /// The best solution; none stands still.
    vectorlib::Transformation2D best() const;
    bool isRight() const { return isWithin(best(), 0.10); }
    double probability() const; ///< of the best solution
};

/// Matches the pairs of a log whose scan poses are a corrected reference without odometry or any other
/// estimate.
std::vector<GlobalPairResult> globalPairsExperiment(const vectorlib::CarmenLog &log,
                                                    const PairsOptions &options);

/// Shares of all pairs, median time and 99th percentile.
nlohmann::ordered_json summaryOf(const std::vector<GlobalPairResult> &pairs);
/// A row a pair.
void writeCsv(std::ostream &out, const std::vector<GlobalPairResult> &pairs);

} // namespace hermes::experiments
