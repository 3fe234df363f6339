#include "daemons/scanmatcher/ScanOutcome.h"

#include <Eigen/LU>

namespace hermes::scanmatcher {

using vectorlib::ScanReport;
using vectorlib::ScanTracker;

namespace {

QString toText(ScanReport::Outcome outcome) {
    static constexpr const char *texts[] = {"matched", "lost", "skipped"};
    return QString(texts[int(outcome)]); // in the order of the enumeration
}

// Nothing where the pairs leave a direction open.
std::optional<Covariance> covariance(const vectorlib::Match &match) {
    const Eigen::FullPivLU<Eigen::Matrix3d> lu(match.information);
    if (match.pairs.empty() || !lu.isInvertible())
        return std::nullopt;
    const Eigen::Matrix3d inverse = lu.inverse();
    Covariance result;
    for (int i = 0; i < 9; ++i)
        result[std::size_t(i)] = inverse(i / 3, i % 3);
    return result;
}

ScanResult resultOf(const ScanTracker &tracker, const Scan &scan) {
    const vectorlib::MapBuilder &builder = tracker.builder;
    const ScanReport &report = builder.report();
    const vectorlib::Match &match = builder.match();
    ScanResult result;
    result.stamp = scan.data.stamp;
    result.pose.pose = report.pose;
    result.pose.twist = tracker.motion().twist();
    const bool isMatched = report.outcome == ScanReport::Outcome::Matched;
    if (isMatched) // else the match does not count
        result.pose.covariance = covariance(match);
    result.pose.outcome = toText(report.outcome);
    result.pose.scan = scan.number;
    result.pose.upsideDown = scan.upsideDown;
    result.pose.trust = tracker.trust();
    if (const auto frame = tracker.odometryFrame())
        result.pose.odometryFrame = frame->pose();
    result.match = {scan.number,
                    match.accepted && isMatched,
                    {},
                    match.reliability,
                    match.ambiguity,
                    match.matchedLength,
                    match.visibleLength,
                    match.rms,
                    {report.segmentMs, report.vectorizeMs, report.matchMs, report.mapMs}};
    for (const vectorlib::CorrespondencePair &p : match.pairs)
        result.match.pairs.push_back({builder.candidates()[size_t(p.fixed)], p.moving});
    const vectorlib::Transformation2D pose(report.pose);
    for (const vectorlib::EdgeRaw2D &edge : builder.edges()) {
        const vectorlib::LineSegment2D<double> s = pose * edge.segment;
        result.segments.push_back({s.begin().x, s.begin().y, s.end().x, s.end().y});
    }
    return result;
}

} // namespace

ScanOutcome outcomeOf(ScanTracker &tracker, const Scan &scan) {
    ScanOutcome o;
    o.result = resultOf(tracker, scan);
    o.outcome = tracker.builder.report().outcome;
    o.points = scan.data.points.size();
    o.counts = tracker.counts();
    o.contradiction = tracker.contradiction();
    o.scanner = tracker.scanner();
    o.second = tracker.second().state();
    o.secondFitting = tracker.second().fitting();
    o.replayed = scan.replayed;
    o.changes = takeChanges(tracker.builder.map);
    return o;
}

} // namespace hermes::scanmatcher
