#include "daemons/scanmatcher/Tracker.h"

namespace hermes {

using vectorlib::ScanReport;

void Tracker::apply(const TrackerSettings &settings) {
    configured = settings;
    builder.extract.vectorize.settings.sigma = settings.sigma;
    vectorlib::TrackingSettings &track = builder.track.settings;
    track.permitted = {settings.permittedXY, settings.permittedXY, settings.permittedAlpha};
    track.expectedDeviationXY = settings.expectedDeviationXY;
    track.expectedDeviationAlpha = settings.expectedDeviationAlpha;
    track.minMatchedShare = settings.minMatchedShare;
}

const ScanReport &Tracker::process(Scan &scan) {
    const float middle = vectorlib::middleTime(scan.seconds);
    scan.stamp += double(middle);
    if (configured.compensateMotion)
        compensateMotion(scan.points, scan.seconds, middle, model.twist());
    builder.extract.segment.settings =
        vectorlib::EarSettings::forScanner(2 * vectorlib::pi, scan.points.size());
    const ScanReport &report = builder.process(scan.points, model.predict(scan.stamp));
    model.update(report.pose, scan.stamp);

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
}

void Tracker::clear() {
    builder.clear();
    model.reset({});
    total = TrackerCounts();
}

} // namespace hermes
