#include "daemons/scanmatcher/Tracker.h"

namespace hermes {

using vectorlib::ScanReport;

void Tracker::apply(const TrackerSettings &settings) {
    configured = settings;
    builder.extract.vectorize.settings.sigma = settings.sigma;
    vectorlib::TrackingSettings &track = builder.track.settings;
    track.permitted = {settings.permittedXY, settings.permittedXY, settings.permittedAlpha};
    track.minMatchedShare = settings.minMatchedShare;
    odometry.setMount(settings.sensorOnRobot);
    search.maxSeconds = settings.relocalizeSeconds;
}

vectorlib::Pose2D Tracker::expect(const Scan &scan) {
    vectorlib::TrackingSettings &track = builder.track.settings;
    const auto expected = scan.odometry ? odometry.expect(*scan.odometry, scan.stamp) : std::nullopt;
    if (expected) {
        ++total.byOdometry;
        track.expectedDeviationXY = expected->deviationXY;
        track.expectedDeviationAlpha = expected->deviationAlpha;
        return expected->pose;
    }
    track.expectedDeviationXY = configured.expectedDeviationXY;
    track.expectedDeviationAlpha = configured.expectedDeviationAlpha;
    return model.predict(scan.stamp);
}

const ScanReport &Tracker::process(Scan &scan) {
    const float middle = vectorlib::middleTime(scan.seconds);
    if (configured.compensateMotion)
        compensateMotion(scan.points, scan.seconds, middle,
                         scan.odometry ? odometry.twist(*scan.odometry, scan.begin(), scan.end())
                                       : model.twist());
    scan.stamp += double(middle);
    builder.extract.segment.settings =
        vectorlib::EarSettings::forScanner(2 * vectorlib::pi, scan.points.size());
    const ScanReport &report = builder.process(scan.points, expect(scan));
    model.update(report.pose, scan.stamp);
    if (scan.odometry)
        odometry.update(report.pose, *scan.odometry, scan.stamp);

    lostInARow = report.outcome == ScanReport::Outcome::Lost ? lostInARow + 1 : 0;
    ++total.scans;
    total.totalMs += report.totalMs();
    switch (report.outcome) {
    case ScanReport::Outcome::Matched:
        ++total.matched;
        break;
    case ScanReport::Outcome::Lost:
        ++total.lost;
        break;
    case ScanReport::Outcome::Skipped:
        ++total.skipped;
        break;
    }
    return report;
}

void Tracker::place(const vectorlib::Pose2D &pose) {
    model.reset(pose);
    odometry.reset();
}

Relocalized Tracker::relocalize(bool apply) {
    if (total.scans == 0)
        return {};
    const Relocalized &result = search(builder.map, builder.edges(), builder.report().pose);
    if (apply && result.isFound())
        place(result.places.front().pose);
    return result;
}

std::optional<Relocalized> Tracker::recover() {
    if (!isSearchDue())
        return std::nullopt;
    const Relocalized result = relocalize(true);
    const std::chrono::duration<double, std::milli> pause(std::max(1000.0, 10 * result.ms));
    nextSearch = std::chrono::steady_clock::now() +
                 std::chrono::duration_cast<std::chrono::steady_clock::duration>(pause);
    return result;
}

bool Tracker::isSearchDue() const {
    // A growing map goes on from the expected pose after some lost scans: from then on it holds the scan
    // itself, at a place that may be wrong, and the search would find that.
    const bool holdsTheScan = builder.settings.grow && lostInARow >= builder.settings.lostBeforeRestart;
    return configured.relocalizeAfter > 0 && lostInARow >= configured.relocalizeAfter && !holdsTheScan &&
           std::chrono::steady_clock::now() >= nextSearch;
}

void Tracker::clear() {
    builder.clear();
    lostInARow = 0;
    place({});
    total = TrackerCounts();
}

} // namespace hermes
