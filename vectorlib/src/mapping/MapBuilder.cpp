#include "vectorlib/mapping/MapBuilder.h"

#include <utility>

namespace vectorlib {

VECTORLIB_BODY const ScanReport &MapBuilder::find(PointSpan<float> given, const Pose2D &expected) {
    if (std::exchange(concluded_, false))
        report_ = ScanReport();
    const auto t0 = Clock::now();
    const PointSpan<float> scan = extract.order(given);
    const Segmentation &clusters = extract.segment(scan);
    const auto t1 = Clock::now();
    const std::vector<EdgeRaw2D> &edges = extract.vectorizeClusters(clusters, scan);
    const auto t2 = Clock::now();
    edges_ = &edges;
    own_ = edges.size();
    if (!beside.empty()) {
        joint_ = edges;
        joint_.insert(joint_.end(), beside.begin(), beside.end());
        edges_ = &joint_;
    }
    byScan_ = false;
    const TrackingSettings usual = track.settings;
    expected_ = settings.matchPrevious ? expectedByPrevious(scan, expected) : Transformation2D(expected);
    locate(expected_);
    track.settings = usual;
    isBent_ = byScan_ && match_.accepted && matchPair.match().agreement.localizability().kept() < 1;
    if (isBent_)
        leaveOpen();
    const auto t3 = Clock::now();
    report_.segmentMs += milliseconds(t0, t1);
    report_.vectorizeMs += milliseconds(t1, t2);
    report_.matchMs += milliseconds(t2, t3);
    return report_;
}

VECTORLIB_BODY const ScanReport &MapBuilder::conclude(PointSpan<float> scan, bool sure) {
    const auto begin = Clock::now();
    concluded_ = true;
    lost_ = report_.outcome == ScanReport::Outcome::Lost ? lost_ + 1 : 0;
    if (!settings.matchPrevious || !sure)
        forgetPrevious();
    else if (passesOver())
        ++passedOver_;
    else
        remember(scan);
    const bool isWelcome =
        report_.outcome == ScanReport::Outcome::Matched ||
        (report_.outcome == ScanReport::Outcome::Lost && lost_ >= settings.lostBeforeRestart);
    if (sure && settings.grow && isWelcome)
        updateMap();
    report_.mapMs = milliseconds(begin, Clock::now());
    return report_;
}

VECTORLIB_BODY void MapBuilder::place(const std::vector<EdgeRaw2D> &edges, const Pose2D &pose) {
    constexpr double sure = 1e-3; // metres, radians
    const TrackingSettings usual = track.settings;
    track.settings.expectedDeviationXY = track.settings.expectedDeviationAlpha = sure;
    const std::vector<EdgeRaw2D> *const last = std::exchange(edges_, &edges);
    const Transformation2D lastPose = pose_;
    const ScanReport lastReport = report_;
    locate(Transformation2D(pose));
    track.settings = usual;
    pose_ = Transformation2D(pose);
    if (report_.outcome != ScanReport::Outcome::Skipped)
        updateMap();
    edges_ = last;
    pose_ = lastPose;
    report_ = lastReport;
}

VECTORLIB_BODY void MapBuilder::correct(VectorMap &other, const Transformation2D &moved) {
    std::swap(map, other);
    match_ = Match();
    numbers_.clear();
    previousPose_ = moved * previousPose_;
}

VECTORLIB_BODY void MapBuilder::clear() {
    map.clear();
    lost_ = 0;
    match_ = Match();
    numbers_.clear();
    forgetPrevious();
}

VECTORLIB_BODY Transformation2D MapBuilder::expectedByPrevious(PointSpan<float> scan, const Pose2D &given) {
    const Transformation2D expected(given);
    followed_ = true;
    if (previousPoints_.empty() || scan.empty())
        return expected;
    const ScanPairMatch &motion =
        matchPair(previousPoints_, previousEdges_, scan, *edges_, previousPose_.inverse() * expected);
    followed_ = motion.accepted;
    if (!motion.accepted)
        return expected;
    track.settings = settings.tracking;
    track.settings.expectedDeviationXY = settings.previousDeviationXY;
    track.settings.expectedDeviationAlpha = settings.previousDeviationAlpha;
    byScan_ = true;
    return previousPose_ * motion.pose;
}

VECTORLIB_BODY void MapBuilder::remember(PointSpan<float> scan) {
    previousPoints_.assign(scan.begin(), scan.end());
    previousEdges_ = *edges_;
    previousPose_ = pose_;
    passedOver_ = 0;
}

VECTORLIB_BODY void MapBuilder::locate(const Transformation2D &expected) {
    pose_ = expected;
    match_ = Match();
    numbers_.clear();
    static_.clear();
    if (edges_->size() < settings.minEdges)
        report_.outcome = ScanReport::Outcome::Skipped;
    else if (map.isEmpty())
        report_.outcome = settings.grow ? ScanReport::Outcome::Matched : ScanReport::Outcome::Lost;
    else {
        collectVisible(expected);
        match_ = track(static_, *edges_, expected);
        report_.outcome = match_.accepted ? ScanReport::Outcome::Matched : ScanReport::Outcome::Lost;
        if (match_.accepted)
            pose_ = match_.pose;
    }
    report_.pose = pose_.pose();
}

VECTORLIB_BODY void MapBuilder::leaveOpen() {
    const Localizability &walls = matchPair.match().agreement.localizability();
    match_.pose = pose_ = walls.leaveOpen(pose_, expected_);
    report_.pose = pose_.pose();
    match_.reliability = std::min(match_.reliability, walls.position().reliability());
}

VECTORLIB_BODY void MapBuilder::collectVisible(const Transformation2D &expected) {
    double reach = 0;
    for (const EdgeRaw2D &e : *edges_)
        reach = std::max({reach, e.segment.begin().squaredNorm(), e.segment.end().squaredNorm()});
    reach = std::sqrt(reach) + std::max(track.settings.permitted.dx, track.settings.permitted.dy);
    const Vector2D<double> centre = expected.translation(), half(reach, reach);
    for (int number : map.near(centre - half, centre + half)) {
        const MapEdge &edge = map.slots()[static_cast<std::size_t>(number)];
        if (edge.observations < settings.leastObservations)
            continue;
        numbers_.push_back(number);
        static_.push_back(edge.segment);
    }
}

VECTORLIB_BODY void MapBuilder::updateMap() {
    partner_.assign(edges_->size(), -1);
    if (report_.outcome == ScanReport::Outcome::Matched)
        for (const CorrespondencePair &p : match_.pairs)
            partner_[static_cast<std::size_t>(p.moving)] = numbers_[static_cast<std::size_t>(p.fixed)];
    for (std::size_t i = 0; i < edges_->size(); ++i) {
        const EdgeRaw2D seen = pose_ * (*edges_)[i];
        int number = partner_[i];
        if (number >= 0 && mergeable(map.slots()[static_cast<std::size_t>(number)].segment, seen.segment) &&
            map.merge(number, seen))
            map.consolidate(number);
        else if (seen.segment.length() >= settings.newEdgeLength) {
            number = map.add(seen);
            map.consolidate(number);
        }
    }
}

} // namespace vectorlib
