#include "gui/vector/MapRun.h"

#include "gui/vector/evaluation/MotionErrors.h"
#include "vectorlib/mapping/WallIds.h"

#include <algorithm>
#include <chrono>

namespace hermes::vector {

using vectorlib::TrackedBy;
using vectorlib::Transformation2D;

void MapRun::take(MapScan &scan) {
    if (scan.partial) {
        ++partial_;
        return;
    }
    // A reference gives the map its frame, by the first pose, and nothing else.
    if (trajectory_.empty() && scan.reference)
        tracker.place(*scan.reference);
    const vectorlib::ScanReport &report = tracker.process(scan);
    trajectory_.push_back({scan.stamp, report.pose});
    if (closesLoops) {
        const bool isMatched = report.outcome == vectorlib::ScanReport::Outcome::Matched;
        loops_.add(scan.points, report.pose,
                   !tracker.isByOdometry() ? TrackedBy::Nothing
                   : isMatched             ? TrackedBy::Map
                                           : TrackedBy::Odometry);
    }
    edges_.emplace_back();
    if (tracker.isStraight())
        edges_.back() = tracker.builder.edges();
    if (scan.reference)
        reference_.push_back({scan.stamp, *scan.reference});
}

void MapRun::finish(const std::function<void(std::size_t, std::size_t)> &progress) {
    if (!closesLoops)
        return;
    const auto begin = std::chrono::steady_clock::now();
    closures_ = loops_.close(progress);
    if (closures_.closed > 0)
        rebuild();
    const auto closed = std::chrono::steady_clock::now();
    reviewed_ = vectorlib::MapReview()(tracker.builder.map, {edges_, poses()});
    closeSeconds_ = std::chrono::duration<double>(closed - begin).count();
    reviewSeconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - closed).count();
}

void MapRun::rebuild() {
    vectorlib::WallIds ids;
    ids.remember(tracker.builder.map, {edges_, poses()});
    tracker.builder.clear();
    for (std::size_t i = 0; i < trajectory_.size(); ++i) {
        trajectory_[i].pose = loops_.poses()[i];
        tracker.builder.place(edges_[i], trajectory_[i].pose);
    }
    ids.keep(tracker.builder.map, {edges_, poses()});
}

std::vector<vectorlib::Pose2D> MapRun::poses() const {
    std::vector<vectorlib::Pose2D> result;
    for (const vectorlib::StampedPose &stamped : trajectory_)
        result.push_back(stamped.pose);
    return result;
}

std::vector<vectorlib::MapEdge> MapRun::segments() const {
    std::vector<vectorlib::MapEdge> result;
    tracker.builder.map.forEach([&](const vectorlib::MapEdge &e) { result.push_back(e); });
    return result;
}

nlohmann::ordered_json MapRun::summary() const {
    const vectorlib::ScanTrackerCounts &counts = tracker.counts();
    const double scans = std::max<double>(1, double(counts.scans));
    nlohmann::ordered_json json;
    json["scans"] = counts.scans + partial_;
    json["skipped"] = counts.skipped + partial_;
    json["matched"] = counts.matched;
    json["lost"] = counts.lost;
    json["closures"] = closures_.closed;
    json["closures_tried"] = closures_.tried;
    json["closures_refused"] = closures_.refused;
    json["ms_per_scan"] = {{"segment", counts.segmentMs / scans},
                           {"vectorize", counts.vectorizeMs / scans},
                           {"match", counts.matchMs / scans},
                           {"map", counts.mapMs / scans}};
    json["closures_seconds"] = closeSeconds_;
    if (closesLoops)
        json["review"] = {{"merged", reviewed_.merged},   {"joined", reviewed_.joined},
                          {"removed", reviewed_.removed}, {"cut", reviewed_.cut},
                          {"corners", reviewed_.corners}, {"contradicted_m", reviewed_.contradicted},
                          {"seconds", reviewSeconds_}};
    json["parallel_twins"] = twins();
    if (reference_.size() > 1)
        json["reference"] = errors();
    return json;
}

nlohmann::ordered_json MapRun::twins() const {
    vectorlib::ParallelTwins find;
    const vectorlib::TwinShare found = find.share(tracker.builder.map, {edges_, poses()});
    return {{"share", found.share()}, {"m", found.twins}, {"of_m", found.walls}, {"real_m", found.real}};
}

// Consecutive motions are compared, as errors of the past do not count twice then; the drift is what they add
// up to.
nlohmann::ordered_json MapRun::errors() const {
    MotionErrors motions;
    const auto motion = [](const std::vector<vectorlib::StampedPose> &poses, std::size_t from,
                           std::size_t to) {
        return Transformation2D(poses[from].pose).inverse() * Transformation2D(poses[to].pose);
    };
    const std::size_t last = reference_.size() - 1;
    for (std::size_t i = 1; i <= last; ++i)
        motions.add(motion(reference_, i - 1, i), motion(trajectory_, i - 1, i));
    const nlohmann::ordered_json of = motions.summary();
    const Transformation2D drift = motion(reference_, 0, last).inverse() * motion(trajectory_, 0, last);
    return {{"motions", motions.size()},
            {"within_10cm_2deg", of["within_10cm_2deg"]},
            {"median_error_m", of["median_m"]},
            {"median_error_deg", of["median_deg"]},
            {"final_drift_m", drift.translation().norm()},
            {"final_drift_deg", std::abs(drift.alpha()) * 180 / vectorlib::pi}};
}

} // namespace hermes::vector
