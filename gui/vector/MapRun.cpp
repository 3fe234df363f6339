#include "gui/vector/MapRun.h"

#include <algorithm>

namespace hermes {

using vectorlib::Pose2D;
using vectorlib::ScanReport;
using vectorlib::Transformation2D;

void MapRun::take(const MapScan &scan) {
    const float middle = vectorlib::middleTime(scan.seconds);
    const double stamp = scan.stamp + double(middle);
    const Pose2D expected = expectedPose(scan, stamp);
    vectorlib::EarSettings scanner = vectorlib::EarSettings::forScanner(scan.fieldOfView, scan.rays);
    scanner.closed = scan.closed;
    builder.extract.segment.settings = segmentation.over(scanner);
    Pose2D pose = expected;
    ScanReport::Outcome outcome = ScanReport::Outcome::Skipped;
    if (!scan.partial) {
        points_ = scan.points;
        const bool wellExpected = isWellExpected(scan, stamp);
        builder.track.settings =
            wellExpected ? vectorlib::TrackingSettings() : vectorlib::TrackingSettings::forPoorExpectation();
        builder.matchPair.settings =
            wellExpected ? vectorlib::ScanPairSettings() : vectorlib::ScanPairSettings::forPoorExpectation();
        builder.settings.matchPrevious = true;
        compensateMotion(points_, scan.seconds, middle, motion_.twist());
        const ScanReport &report = builder.process(points_, expected);
        pose = report.pose;
        outcome = report.outcome;
        segmentMs_ += report.segmentMs;
        vectorizeMs_ += report.vectorizeMs;
        matchMs_ += report.matchMs;
        mapMs_ += report.mapMs;
    }
    ++(outcome == ScanReport::Outcome::Matched ? matched_
       : outcome == ScanReport::Outcome::Lost  ? lost_
                                               : skipped_);
    motion_.update(pose, stamp);
    trajectory_.push_back({stamp, pose});
    if (scan.reference)
        reference_.push_back({stamp, *scan.reference});
}

// By odometry, or because the last scan was a moment ago.
bool MapRun::isWellExpected(const MapScan &scan, double stamp) const {
    constexpr double moment = 0.5; // seconds
    if (trajectory_.empty() || (useOdometry && scan.motion))
        return true;
    const double since = stamp - trajectory_.back().stamp;
    return since > 0 && since <= moment;
}

// A reference gives the map its frame, by the first pose, and nothing else.
Pose2D MapRun::expectedPose(const MapScan &scan, double stamp) const {
    if (trajectory_.empty())
        return scan.reference ? *scan.reference : Pose2D();
    if (useOdometry && scan.motion)
        return (Transformation2D(trajectory_.back().pose) * *scan.motion).pose();
    return motion_.predict(stamp);
}

std::vector<vectorlib::MapEdge> MapRun::segments() const {
    std::vector<vectorlib::MapEdge> result;
    builder.map.forEach([&](const vectorlib::MapEdge &e) { result.push_back(e); });
    return result;
}

nlohmann::ordered_json MapRun::summary() const {
    const double scans = std::max<double>(1, double(trajectory_.size()));
    nlohmann::ordered_json json;
    json["scans"] = trajectory_.size();
    json["skipped"] = skipped_;
    json["matched"] = matched_;
    json["lost"] = lost_;
    json["closures"] = 0;
    json["ms_per_scan"] = {{"segment", segmentMs_ / scans},
                           {"vectorize", vectorizeMs_ / scans},
                           {"match", matchMs_ / scans},
                           {"map", mapMs_ / scans}};
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

} // namespace hermes
