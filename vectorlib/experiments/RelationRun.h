#pragma once

#include "gui/vector/ProgressParts.h"
#include "vectorlib/experiments/Plot.h"
#include "vectorlib/experiments/RelationScans.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/relations/MatchErrors.h"
#include "vectorlib/relations/RelationMatcher.h"

#include <nlohmann/json.hpp>

#include <ostream>

namespace hermes::experiments {

using vector::ProgressParts;
using vector::ProgressSink;

/// One scan of a run: where it was put, and how well. Errors as in pose-free thesis 6.2.
struct RelationStep {
    vectorlib::RelationOutcome outcome = vectorlib::RelationOutcome::Matched;
    vectorlib::Pose2D estimate, truth;
    vectorlib::PoseError error;          ///< of the motion since the scan it was matched with
    vectorlib::PoseError publishedError; ///< the same in the frame of the map, as the thesis computes it
    vectorlib::PoseError globalError;    ///< of the pose
    vectorlib::MatchedArea area;
    std::size_t segments = 0, pairs = 0;
    double microseconds = 0; ///< matching of two vectorized scans
};

/// A way on which every scan was matched with the one before and nothing else was known.
struct RelationRun {
    std::vector<RelationStep> steps; ///< the first stands at its true pose
    std::vector<vectorlib::LineSegment2D<double>> map;
    double length = 0; ///< of the true way; metres

    std::size_t lost() const;  ///< scans that were not matched
    std::size_t wrong() const; ///< matched ones whose motion is wrong by more than 0.5 m or 10 degrees
};

struct RelationRunOptions {
    double fieldOfView = vectorlib::pi;
    std::size_t rays = halfTurnRays;
    ProgressSink progress;
};

/// Matches each scan with the last one that was matched, and makes a local map of them (Algorithm 11). A scan
/// that does not match is left out; the eleventh in a row is kept as if the sensor had not moved, and the
/// next one is matched with it.
RelationRun relationRun(const std::vector<PosedScan> &scans, const RelationRunOptions &options);

/// Shares, mean errors and times, beside what is published for this run (none: an empty object).
nlohmann::ordered_json summaryOf(const RelationRun &run, const nlohmann::ordered_json &published);
void writeCsv(std::ostream &out, const RelationRun &run);
/// The map in the frame of the first scan, the true and the estimated way.
vectorlib::SvgPicture pictureOfWays(const RelationRun &run);
/// The four errors, the error area percentage.
std::vector<Plot> plotsOf(const RelationRun &run);

} // namespace hermes::experiments
