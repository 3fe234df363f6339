#pragma once

#include "common/world/World.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/observation/SimulatedScanner.h"

#include <cstdint>
#include <vector>

namespace hermes::experiments {

/// A scan and where it was taken; the points in the sensor's frame, counter-clockwise.
struct PosedScan {
    std::vector<vectorlib::Vector2D<float>> points;
    vectorlib::Pose2D pose;
};

/// The scanner of the pose-free thesis (6.1): a half turn at 1 degree, ranges wrong by up to 2.5 cm and
/// directions by up to 0.1 degree, both spread evenly. Rays without a wall within 30 m have no return.
vectorlib::SimulatedScanner<double> halfTurnScanner(std::uint64_t seed);
constexpr int halfTurnRays = 181;

/// So many poses at even steps along a smooth way through all poses of a world, headed as it goes. Each part
/// is a cubic curve that is nearly an arc.
std::vector<vectorlib::Pose2D> posesAlong(const World &world, std::size_t count);
/// How far it is along the poses; metres.
double lengthOf(const std::vector<vectorlib::Pose2D> &poses);

/// A scan at every pose.
std::vector<PosedScan> scansAt(const World &world, const std::vector<vectorlib::Pose2D> &poses,
                               vectorlib::SimulatedScanner<double> scanner);

} // namespace hermes::experiments
