#pragma once

#include "vectorlib/experiments/RelationRun.h"

namespace hermes::experiments {

/// The error area of a scan laid on its exact copy with an error put in. Pose-free thesis figure 6.8.
struct InjectedError {
    bool isRotation = false;
    double amount = 0; ///< degrees or metres
    double area = 0;   ///< m^2
};

/// A scan of a world at its first pose; turned by up to 30 degrees, moved along x by up to 1 m.
std::vector<InjectedError> injectedErrors(const World &world, std::uint64_t seed);
/// The areas at 10 degrees and at 50 cm, and whether the area grows with every step of the error.
nlohmann::ordered_json summaryOf(const std::vector<InjectedError> &rows);
void writeCsv(std::ostream &out, const std::vector<InjectedError> &rows);
std::vector<Plot> plotsOf(const std::vector<InjectedError> &rows);

/// The error area of two scans by how far they were taken from each other. Pose-free thesis figure 6.10.
struct DistanceArea {
    bool isAll = false;  ///< all pairs, in bins of 1 cm; else the first scan with all others
    double distance = 0; ///< metres
    double area = 0;     ///< m^2; mean of a bin
    std::size_t pairs = 0;
};

struct ApproachResult {
    std::vector<DistanceArea> rows;
    std::size_t pairs = 0, matched = 0;
    double meanFirst = 0, meanAll = 0;   ///< error area; m^2
    double slopeFirst = 0, slopeAll = 0; ///< of the area by the distance, least squares; m^2 a metre
};

/// 1,480 scans on the way of a world; of all pairs only those of every N-th scan.
ApproachResult approach(const World &world, std::uint64_t seed, std::size_t every,
                        const ProgressSink &progress);
void writeCsv(std::ostream &out, const ApproachResult &result);
std::vector<Plot> plotsOf(const ApproachResult &result);
nlohmann::ordered_json summaryOf(const ApproachResult &result);

} // namespace hermes::experiments
