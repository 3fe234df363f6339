#include "gui/vector/MapRun.h"
#include "gui/vector/Failure.h"
#include "gui/vector/Quantile.h"
#include "gui/vector/evaluation/MotionErrors.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/mapping/WallEvidence.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <ostream>

namespace hermes::vector {

void LocalizeRun::take(const MapScan &scan) {
    if (scan.fault == MapScan::Fault::None)
        localizer.take(scan);
    else
        ++leftOut_;
}

void LocalizeRun::finish(const std::string &log) {
    localizer.finish();
    if (localizer.placesFound() > 0)
        return;
    const auto count = [](std::size_t n) { return std::to_string(n); };
    throw Failure(log + ": not found in the map " + file_ + ": sought " + count(localizer.searches()) +
                  " of " + count(localizer.scans().size()) + " scans, and " +
                  (localizer.placesDropped() > 0 ? "none of " + count(localizer.placesDropped()) +
                                                       " places that seemed right was confirmed"
                                                 : std::string("none fits in one place only")) +
                  "; expected two scans at least 1 m or 0.6 rad apart that agree");
}

std::vector<vectorlib::StampedPose> LocalizeRun::trajectory() const {
    std::vector<vectorlib::StampedPose> poses;
    for (const vectorlib::LocalizedScan &scan : localizer.scans())
        if (scan.pose)
            poses.push_back({scan.stamp, *scan.pose});
    return poses;
}

nlohmann::ordered_json LocalizeRun::summary() const {
    const std::vector<vectorlib::LocalizedScan> &scans = localizer.scans();
    const std::size_t all = scans.size() + leftOut_;
    const auto count = [&](auto is) { return std::size_t(std::count_if(scans.begin(), scans.end(), is)); };
    const std::size_t matched = count([](const auto &s) { return s.matched; });
    const std::size_t posed = count([](const auto &s) { return s.pose.has_value(); });
    const vectorlib::ScanTrackerCounts &counts = localizer.tracker.counts();
    const double tracked = std::max<double>(1, double(counts.scans));
    nlohmann::ordered_json json;
    json["scans"] = all;
    json["skipped"] = leftOut_;
    json["matched"] = matched;
    json["lost"] = posed - matched;
    json["without_pose"] = all - posed;
    json["with_pose_share"] = double(posed) / double(std::max<std::size_t>(1, all));
    json["relocalized"] = localizer.placesFound();
    json["searches"] = localizer.searches();
    json["ms_per_scan"] = {{"segment", counts.segmentMs / tracked},
                           {"vectorize", counts.vectorizeMs / tracked},
                           {"match", counts.matchMs / tracked}};
    return json;
}

using vectorlib::Transformation2D;

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

} // namespace

void MapRun::take(MapScan &scan) {
    if (scan.fault != MapScan::Fault::None) {
        ++leftOut_;
        return;
    }
    // A reference gives the map its frame, by the first pose, and nothing else.
    if (trajectory_.empty() && scan.reference)
        tracker.place(*scan.reference);
    const vectorlib::ScanReport &report = tracker.process(scan);
    if (closesLoops)
        remember(scan, report);
    trajectory_.push_back({scan.stamp, report.pose});
    trust_.push_back(tracker.trust());
    if (scan.reference)
        reference_.push_back({scan.stamp, *scan.reference});
}

void MapRun::remember(const MapScan &scan, const vectorlib::ScanReport &report) {
    const auto begin = Clock::now();
    const Transformation2D pose(report.pose);
    static const std::vector<vectorlib::EdgeRaw2D> none;
    const Transformation2D tracked =
        trajectory_.empty() ? pose : tracker.tracked(Transformation2D(trajectory_.back().pose));
    drive_.add(scan.points, tracker.isStraight() ? tracker.builder.edges() : none, tracked,
               tracker.trackedBy(), std::uint32_t(tracker.builder.own()));
    refine_.add(scan.points, tracked);
    if (drive_.loops.isDue())
        drive_.loops.correct();
    closeSeconds_ += secondsSince(begin);
}

void MapRun::finish(const std::function<void(const char *)> &begin, const ProgressSink &progress) {
    if (!closesLoops)
        return;
    const auto begun = Clock::now();
    // Parts of the time, about; the last one is the review.
    constexpr std::size_t correct = 10, refine = 30, rebuildMap = 40, allParts = 100;
    ProgressParts parts(progress, {correct, refine, rebuildMap, allParts - correct - refine - rebuildMap});
    begin("closing loops");
    drive_.loops.correct(parts.next());
    std::vector<vectorlib::Pose2D> found = drive_.loops.poses();
    if (!found.empty())
        parts_ = divide_(drive_, found);
    if (drive_.loops.counts().closed > 0 || parts_.size() > 1)
        rebuild(std::move(found), begin, parts);
    closeSeconds_ += secondsSince(begun);
    const auto closed = Clock::now();
    begin("reviewing the walls");
    reviewed_ = drive_.review(tracker.builder.map, poses());
    reviewSeconds_ = secondsSince(closed);
    progress(allParts, allParts);
}

void MapRun::rebuild(std::vector<vectorlib::Pose2D> refined, const std::function<void(const char *)> &begin,
                     ProgressParts &parts) {
    vectorlib::WallIds ids;
    ids.remember(tracker.builder.map, {drive_.edges(), poses()});
    begin("refining the poses");
    isRefined_ = refine_(refined, drive_.loopsOfScans(), parts.next());
    for (std::size_t i = 0; i < refined.size(); ++i)
        trajectory_[i].pose = refined[i];
    for (std::size_t i = 1; i < parts_.size(); ++i)
        trajectory_[parts_[i].begin].isApart = true;
    begin("making the map anew");
    drive_.rebuild(tracker.builder, refined, parts.next());
    ids.keep(tracker.builder.map, {drive_.edges(), refined});
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
    json["scans"] = counts.scans + leftOut_;
    json["skipped"] = counts.skipped + leftOut_;
    json["matched"] = counts.matched;
    json["lost"] = counts.lost;
    json["doubted"] = counts.doubted;
    json["restarts"] = counts.restarts;
    json["by_odometry"] = counts.byOdometry;
    if (!trust_.empty())
        json["trust"] = {{"mean", std::accumulate(trust_.begin(), trust_.end(), 0.0) / double(trust_.size())},
                         {"percentile_5", quantile(trust_, 0.05)}};
    const vectorlib::LoopCounts loops = drive_.loops.counts();
    json["refined"] = isRefined_;
    json["closures"] = loops.closed;
    json["closures_tried"] = loops.tried;
    json["closures_refused"] = loops.refused;
    json["ms_per_scan"] = {{"segment", counts.segmentMs / scans},
                           {"vectorize", counts.vectorizeMs / scans},
                           {"match", counts.matchMs / scans},
                           {"map", counts.mapMs / scans}};
    json["closures_seconds"] = closeSeconds_;
    if (parts_.size() > 1)
        json["parts"] = parts();
    if (closesLoops) {
        json["review"] = {{"merged", reviewed_.merged},   {"joined", reviewed_.joined},
                          {"removed", reviewed_.removed}, {"cut", reviewed_.cut},
                          {"corners", reviewed_.corners}, {"contradicted_m", reviewed_.contradicted},
                          {"seconds", reviewSeconds_}};
        json["parallel_twins"] = twins();
    }
    if (reference_.size() > 1)
        json["reference"] = errors();
    return json;
}

void MapRun::warnOfBreaks(std::ostream &out) const {
    for (std::size_t i = 1; i < parts_.size(); ++i)
        out << "hermes-vector: the way to pose " << parts_[i].begin << " (stamp "
            << vectorlib::Fixed{trajectory_[parts_[i].begin].stamp, 3}
            << ") is not known: what was seen from there on contradicts what was seen before\n";
    const auto count = std::count_if(parts_.begin(), parts_.end(), [](const auto &p) { return p.isJoined; });
    if (parts_.size() > 1 && count > 1)
        out << "hermes-vector: " << count << " of " << parts_.size() << " parts are joined by their walls\n";
    for (const vectorlib::DrivePart &part : parts_)
        if (!part.isJoined)
            out << "hermes-vector: poses " << part.begin << " to " << part.end - 1
                << " are laid beside the map: no walls tell where they belong (map-merge joins two maps)\n";
}

nlohmann::ordered_json MapRun::parts() const {
    nlohmann::ordered_json array = nlohmann::ordered_json::array();
    for (const vectorlib::DrivePart &part : parts_)
        array.push_back({{"first", part.begin},
                         {"scans", part.end - part.begin},
                         {"stamp", trajectory_[part.begin].stamp},
                         {"joined", part.isJoined}});
    return array;
}

nlohmann::ordered_json MapRun::twins() const {
    vectorlib::ParallelTwins find;
    const vectorlib::TwinShare found = find.share(tracker.builder.map, {drive_.edges(), poses()});
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
