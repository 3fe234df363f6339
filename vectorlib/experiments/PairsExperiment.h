#pragma once

#include "gui/vector/ProgressParts.h"
#include "gui/vector/Quantile.h"
#include "vectorlib/io/CarmenLog.h"
#include "vectorlib/mapping/ScanPairMatcher.h"

#include <nlohmann/json.hpp>

#include <ostream>
#include <vector>

namespace hermes::experiments {

using vector::ProgressParts;
using vector::ProgressSink;

/// Which half of the pairs: parameters are chosen on one half and judged on the other.
enum class PairHalf { Both, First, Second };

struct PairsOptions {
    std::size_t every = 1; ///< match each N-th scan with the next N-th one
    std::size_t first = 0; ///< only so many pairs; 0: all
    /// Blocks of 50 pairs belong to the first and to the second half in turn.
    PairHalf half = PairHalf::Both;
    ProgressSink progress;

    /// Numbers of the first scan of each pair.
    std::vector<std::size_t> pairsOf(const vectorlib::CarmenLog &log) const;
};

/// Two scans of a log and the motion between them by the reference.
struct LogPair {
    std::size_t from = 0, to = 0; ///< numbers of the scans
    vectorlib::Transformation2D reference;

    double errorMetres(const vectorlib::Transformation2D &motion) const;
    double errorDegrees(const vectorlib::Transformation2D &motion) const;
    bool isWithin(const vectorlib::Transformation2D &motion, double metres) const; ///< and 2 degrees
    bool isWrong(const vectorlib::Transformation2D &motion) const; ///< over 0.5 m or 10 degrees
};

/// A pair, the motion that was found and how long that took.
struct PairResult : LogPair {
    vectorlib::Transformation2D expected; ///< by odometry
    vectorlib::ScanPairMatch match;
    double microseconds = 0; ///< segmentation and vectorization of both scans and the match
};

using ScanPoints = std::vector<vectorlib::Vector2D<float>>;
/// The points of a scan, in its sensor's frame.
ScanPoints pointsOf(const vectorlib::CarmenScan &scan);

/// Matches the pairs of a log whose scan poses are a corrected reference, each from the motion that its
/// odometry tells; nothing of the reference is used but for the errors. A pair without odometry is expected
/// to stand still, and matched as such a guess deserves.
std::vector<PairResult> pairsExperiment(const vectorlib::CarmenLog &log, const PairsOptions &options);

/// Shares of all pairs and the median time.
nlohmann::ordered_json summaryOf(const std::vector<PairResult> &pairs);
/// A row a pair.
void writeCsv(std::ostream &out, const std::vector<PairResult> &pairs);
/// Both scans, laid on each other as found; the second one also as the reference says.
void draw(std::ostream &svg, const vectorlib::CarmenLog &log, const LogPair &pair,
          const vectorlib::Transformation2D &found);

} // namespace hermes::experiments
