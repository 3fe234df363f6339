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

void Tracker::clear() {
    builder.clear();
    place({});
    total = TrackerCounts();
}

} // namespace hermes
