#pragma once

#include "gui/vector/ProgressParts.h"
#include "vectorlib/io/CarmenLog.h"
#include "vectorlib/mapping/ScanTracker.h"

#include <nlohmann/json.hpp>

#include <ostream>
#include <string>
#include <vector>

namespace hermes::experiments {

using vector::ProgressParts;
using vector::ProgressSink;

/// A pose that ScanTracker found in the map, and whether it is right.
struct PoseTrial {
    std::string set;
    enum class Part { First, Second, Never } part = Part::First; ///< Never: of a log that is for no fit
    std::size_t scan = 0;                                        ///< its number in the drive
    vectorlib::PoseTrust::Features features{};
    /// Most of the motions to it from the five poses before are within 10 cm and 2 degrees of the reference.
    bool isRight = false;
};

/// Drives of a log whose scan poses are a corrected reference: with each scan and with each fifth, by its
/// odometry and without. Blocks of 50 poses belong to the first and the second part in turn; those of a
/// `strange` log to neither. Sets are called after the log.
std::vector<PoseTrial> posesOfLog(const std::string &name, const vectorlib::CarmenLog &log, bool strange,
                                  const ProgressSink &progress);
/// So many drives through drawn buildings; each belongs to one part, in turn.
std::vector<PoseTrial> posesOfDrawnDrives(std::uint64_t seed, int drives, const ProgressSink &progress);
/// Poses that those two track: steps of their progress.
std::size_t countPoses(const vectorlib::CarmenLog &log);
std::size_t countPoses(int drives);

/// The weights of the least loss on the first part.
vectorlib::PoseTrust fittedPoseTrust(const std::vector<PoseTrial> &trials);
/// How well the present weights and those fitted to the first part do on each of the parts and sets: the mean
/// of -ln of the probability of what was the case, wrong poses that are told above 0.9, and the tenths.
nlohmann::ordered_json poseTrustSummary(const std::vector<PoseTrial> &trials);
/// A row a pose.
void writeCsv(std::ostream &out, const std::vector<PoseTrial> &trials);

} // namespace hermes::experiments
