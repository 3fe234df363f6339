#pragma once

#include "common/world/World.h"
#include "vectorlib/geometry/LineSegment2D.h"

#include "vectorlib/io/Svg.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <ostream>

namespace hermes::experiments {

/// How wrong an odometry is, motion by motion: always the same way, and by chance (standard deviations).
struct OdometryErrors {
    double scale = 0;                                 ///< share that a way is told longer
    double turn = 0;                                  ///< to the left; radians
    double deviationXY = 0.02, deviationAlpha = 0.01; ///< metres, radians

    static OdometryErrors exaggerated() { return {0.15, 0.06, 0.03, 0.03}; } ///< overview paper 2.4, first
    static OdometryErrors usual() { return {0.02, 0.004, 0.02, 0.01}; }      ///< the second
};

/// A scan of a drive that stands still for each.
struct OverviewScan {
    vectorlib::Pose2D truth, odometry, found;
    bool isMatched = false;
    std::vector<vectorlib::Vector2D<float>> points; ///< sensor frame
};

/// A drive through the poses of a world, mapped by MapBuilder: overview paper 2.4.
struct OverviewRun {
    std::uint64_t seed = 0;
    std::vector<OverviewScan> scans;
    std::vector<vectorlib::LineSegment2D<double>> edges; ///< of the map

    double length() const;
    /// How far the last pose lies from where it truly is; metres.
    double closingError() const;
    double odometryClosingError() const;
};

/// One edge of a map is long enough to take part in fitting, or only decorates it; metres. The paper names no
/// length.
constexpr double longEdge = 0.5;

/// What finds the poses: our tracker, or the matcher of the paper with edges of longEdge and more.
enum class OverviewMatcher { Tracker, Quadrangle };

/// Noise of the range 2 cm and 2,000 rays a turn, as of the paper's scanner.
OverviewRun overviewRun(const World &world, const OdometryErrors &errors, std::uint64_t seed,
                        OverviewMatcher matcher = OverviewMatcher::Tracker);

void writeCsv(std::ostream &out, const std::vector<OverviewRun> &runs);
/// Of the first run and of all; `older` are those with the paper's matcher.
nlohmann::ordered_json summaryOf(const std::vector<OverviewRun> &runs, const std::vector<OverviewRun> &older,
                                 const nlohmann::ordered_json &published);

/// Paper figure 2a: all points where the odometry puts them, and its way.
vectorlib::SvgPicture pictureOfRaw(const std::string &title, const OverviewRun &run);
/// Figures 2b and 2c: one scan by clusters, outliers left out, and its lines.
vectorlib::SvgPicture pictureOfScan(const std::string &title, const OverviewScan &scan);
/// Figures 2d and 4: long and short edges of the map, the odometry's way and the corrected one.
vectorlib::SvgPicture pictureOfMap(const std::string &title, const OverviewRun &run);

} // namespace hermes::experiments
