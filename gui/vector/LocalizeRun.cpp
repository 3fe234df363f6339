#include "gui/vector/LocalizeRun.h"

#include "gui/vector/Failure.h"

#include <algorithm>

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

} // namespace hermes::vector
