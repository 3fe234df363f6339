#pragma once

#include "common/world/World.h"
#include "vectorlib/correspondence/CorrespondenceFinder.h"

#include <cstdint>

namespace hermes::experiments {

using Segments = std::vector<vectorlib::LineSegment2D<double>>;

/// How scans are made for a report.
struct ScanSettings {
    int rays = 2000;
    double noise = 0.01; ///< standard deviation of the range; metres
    double sigma = 0.03; ///< largest error of a line; metres
    std::uint64_t seed = 1;
};

/// A simulated scan, its segments and the edges of the world that each shows; in the sensor's frame.
struct VectorScan {
    std::vector<vectorlib::Vector2D<float>> points;
    Segments segments;
    std::vector<std::vector<int>> edges; ///< their numbers in the world; a segment may run over several steps
};

/// The edges of a world; metres, free space on the left.
Segments edgesOf(const World &world);

/// Scans a world from a pose, segments and vectorizes the scan (EarSegmenter, AFTLS), and labels the segments
/// with the edges that run beside them.
VectorScan scanWorld(const Segments &world, const vectorlib::Pose2D &pose, const ScanSettings &settings);

/// How well the pairs of a solution are chosen. A pair of the static and the dynamic set is true when both
/// show the same edge of the world and overlap at the true transformation.
struct PairCounts {
    int truePositive = 0, trueNegative = 0, falsePositive = 0, falseNegative = 0;
};

/// Two scans to be registered, with the truth.
struct ScanPair {
    VectorScan fixed, moving;
    vectorlib::Transformation2D truth; ///< moves the second scan onto the first

    /// Of all pairs that the permitted set of transformations allows.
    PairCounts count(const vectorlib::Solution &solution, const vectorlib::PermittedError &permitted) const;
    /// Whether the solution's pose is within 10 cm and 2 degrees of the truth.
    bool isTrue(const vectorlib::Solution &solution) const;
};

ScanPair scanPair(const Segments &world, const vectorlib::Pose2D &first, const vectorlib::Pose2D &second,
                  const ScanSettings &settings);

} // namespace hermes::experiments
