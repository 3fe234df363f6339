#pragma once

#include "vectorlib/experiments/Plot.h"
#include "vectorlib/experiments/VectorizationExperiment.h"
#include "vectorlib/experiments/report/ScanPair.h"

namespace hermes::experiments {

/// The worlds and the scans in which the stages of the correspondence search are shown.
struct SearchScene {
    std::string name;
    std::vector<ScanPair> pairs; ///< consecutive scans
};

/// The example of thesis figures 7.16 to 7.18 and 7.20, after their description: two major directions,
/// north-west and north-east, in which parallel walls are met in five and in three positions. Two poses.
World searchExample();
/// How it is scanned: with 3 mm of noise and lines to 1 cm. To 3 cm, as in the appendices, lines of 40 cm, as
/// it has them, take in the ends of their neighbours and are not known well enough to be told apart.
ScanSettings searchExampleScans();
/// The consecutive scans of a world; the seed is not that of the settings.
SearchScene searchScene(const World &world, std::uint64_t seed, ScanSettings settings = {});

/// How much the search has to look at when the pose is known with an accuracy; means of a scan pair.
struct SearchStages {
    std::string scene;
    double accuracy = 0; ///< the permitted |dx| and |dy|; metres
    double angle = 0;    ///< the permitted |dalpha|; radians
    int searches = 0;
    double potentialPairs = 0;
    double truePairs = 0; ///< of these
    double bundles = 0;   ///< by the published rules
    double buckets = 0;
    double tried = 0;        ///< bundles, to find all their combinations
    double solutions = 0;    ///< combinations, but parts of larger ones
    double microseconds = 0; ///< processor time of CorrespondenceFinder

    double pairsOfOne() const { return truePairs > 0 ? potentialPairs / truePairs : 0; }
};

/// Thesis figure 7.17 as a curve: accuracies of 5 cm to 2.4 m, and with each metre the 1.05 rad of the
/// appendices (1.26 rad with 1.2 m). The expected pose errs by any transformation that is permitted.
std::vector<SearchStages> searchStages(const std::vector<SearchScene> &scenes,
                                       const ExperimentOptions &options);

void writeCsv(std::ostream &out, const std::vector<SearchStages> &rows);
std::vector<Plot> plotsOf(const std::vector<SearchStages> &rows);

} // namespace hermes::experiments
