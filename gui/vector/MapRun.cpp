#include "gui/vector/MapRun.h"

#include <algorithm>

namespace hermes::vector {

using vectorlib::Transformation2D;

void MapRun::take(MapScan &scan) {
    if (scan.partial) {
        ++partial_;
        return;
    }
    // A reference gives the map its frame, by the first pose, and nothing else.
    if (trajectory_.empty() && scan.reference)
        tracker.place(*scan.reference);
    const vectorlib::Pose2D pose = tracker.process(scan).pose;
    trajectory_.push_back({scan.stamp, pose});
    if (scan.reference)
        reference_.push_back({scan.stamp, *scan.reference});
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
    json["closures"] = 0;
    json["ms_per_scan"] = {{"segment", counts.segmentMs / scans},
                           {"vectorize", counts.vectorizeMs / scans},
                           {"match", counts.matchMs / scans},
                           {"map", counts.mapMs / scans}};
    if (reference_.size() > 1)
        json["reference"] = errors();
    return json;
}

// Consecutive motions are compared, as errors of the past do not count twice then; the drift is what they add
// up to.
nlohmann::ordered_json MapRun::errors() const {
    constexpr double nearMetres = 0.10, nearDegrees = 2;
    constexpr double degrees = 180 / vectorlib::pi;
    std::vector<double> metres, turned;
    std::size_t near = 0;
    const auto difference = [&](std::size_t from, std::size_t to) {
        const auto motion = [&](const std::vector<vectorlib::StampedPose> &poses) {
            return Transformation2D(poses[from].pose).inverse() * Transformation2D(poses[to].pose);
        };
        return motion(reference_).inverse() * motion(trajectory_);
    };
    for (std::size_t i = 1; i < reference_.size(); ++i) {
        const Transformation2D d = difference(i - 1, i);
        metres.push_back(d.translation().norm());
        turned.push_back(std::abs(d.alpha()) * degrees);
        near += metres.back() <= nearMetres && turned.back() <= nearDegrees;
    }
    const auto median = [](std::vector<double> &values) {
        const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    };
    const Transformation2D drift = difference(0, reference_.size() - 1);
    return {{"motions", metres.size()},
            {"within_10cm_2deg", double(near) / double(metres.size())},
            {"median_error_m", median(metres)},
            {"median_error_deg", median(turned)},
            {"final_drift_m", drift.translation().norm()},
            {"final_drift_deg", std::abs(drift.alpha()) * degrees}};
}

} // namespace hermes::vector
