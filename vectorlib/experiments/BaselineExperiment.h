#pragma once

#include "common/world/World.h"
#include "vectorlib/experiments/PairsExperiment.h"
#include "vectorlib/experiments/Plot.h"

#include <cstdint>

namespace hermes::experiments {

/// Two scans to be matched and the true motion between them.
struct BaselinePair {
    ScanPoints fixed, moving;
    vectorlib::Transformation2D motion;
    vectorlib::EarSettings segmentation;
};

/// Pairs of one kind.
struct BaselineSet {
    std::string name;
    std::vector<BaselinePair> pairs;
};

/// What one matcher made of all pairs of a set whose expected motion is off by so much.
struct BaselineRow {
    std::string set, matcher;
    double offMetres = 0, offDegrees = 0; ///< of the expected motion from the true one
    std::size_t tries = 0, right = 0;     ///< right: within 10 cm and 2 degrees
    std::size_t accepted = 0, acceptedWrong = 0;
    double medianMetres = 0, medianDegrees = 0; ///< of the errors
    double microseconds = 0; ///< of the processor for a match of two vectorized scans, mean

    double rightShare() const { return tries > 0 ? double(right) / double(tries) : 0; }
};

/// Each scan of a world with the next one: 2,000 rays, noise 2 cm.
BaselineSet baselineSet(const World &world, std::uint64_t seed);
BaselineSet baselineSet(const std::string &name, const vectorlib::CarmenLog &log,
                        const PairsOptions &options);

/// The matcher of overview paper 2.2, its pairs with our criterion, our tracker and our pair matcher, on the
/// same pairs with the same errors of the expected motion, `runs` for each pair and size.
std::vector<BaselineRow> baselineExperiment(const std::vector<BaselineSet> &sets, std::uint64_t seed,
                                            int runs, const ProgressSink &progress);

void writeCsv(std::ostream &out, const std::vector<BaselineRow> &rows);
nlohmann::ordered_json summaryOf(const std::vector<BaselineRow> &rows);
/// For each set the share that is right by the error of the expected motion, a curve a matcher.
std::vector<Plot> plotsOf(const std::vector<BaselineRow> &rows);

} // namespace hermes::experiments
