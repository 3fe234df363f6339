#include "vectorlib/mapping/ScanTracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vectorlib {

VECTORLIB_BODY void ScanTracker::apply(const ScanTrackerSettings &settings) {
    settings_ = settings;
    builder.settings.matchPrevious = true;
    builder.settings.tracking = settings.tracking;
    locate_.compensateMotion = settings.compensateMotion;
    locate_.tracking = settings.tracking;
    locate_.moment = settings.moment;
    locate_.setMount(settings.sensorOnRobot);
    locate_.second.setMounts(settings.sensorOnRobot, settings.secondOnRobot);
    check_.restart(); // with another mount the robot is elsewhere
    scanner_ = ScannerCheck();
    search_.maxSeconds = settings.relocalizeSeconds;
}

VECTORLIB_BODY const ScanReport &ScanTracker::process(TimedScan &scan) {
    // What is known before the scan.
    const Transformation2D before(builder.report().pose);
    wasPlaced_ = std::exchange(isPlaced_, false);
    wasMatched_ = isMatched();
    setUp(scan);
    // Its pose in the map, from where the odometry or the motion so far leads.
    const std::optional<double> lastStamp = locate_.lastStamp();
    located_ = locate_(builder, scan, open_);
    counts_.byOdometry += located_.byOdometry;
    // Whether the second scanner shows the same map from its place.
    checkSecond(scan);
    // Whether scans and odometry tell the same of the scanner.
    checkScanner(before, lastStamp, scan.stamp);
    // Whether the map speaks against the pose: the scan is lost then.
    judge(scan, lastStamp);
    // The map grows.
    builder.settings.grow = draws();
    const ScanReport &report = builder.conclude(scan.points, located_.isStraight);
    points_ = scan.points;
    // What the motion, the odometry and open walls tell of the next scan.
    locate_.update(report.pose, scan);
    checkOdometry(scan);
    followOpen(scan);
    // What is known of the place now.
    count(report);
    place_.settle(isMatched() && agrees() && (isAfterPause_ || open_.belief() > claimed));
    isUnguided_ = isUnguided_ && !(isMatched() && place_.isKnown());
    return report;
}

VECTORLIB_BODY void ScanTracker::setUp(TimedScan &scan) {
    if (!settings_.useOdometry)
        scan.odometry.reset();
    EarSettings scanner = EarSettings::forScanner(scan.fieldOfView, scan.rays);
    scanner.closed = scan.closed;
    builder.extract.segment.settings = segmentation ? segmentation(scanner) : scanner;
    builder.settings.grow = maps();
}

VECTORLIB_BODY void ScanTracker::checkScanner(const Transformation2D &before,
                                              const std::optional<double> &lastStamp, double stamp) {
    if (located_.isOdometryKnown && lastStamp && wasMatched_ && builder.isExpectedByScan() &&
        builder.matchPair.match().linesSuffice)
        scanner_.add(located_.way, before.inverse() * builder.expected(), stamp - *lastStamp);
}

VECTORLIB_BODY void ScanTracker::checkSecond(const TimedScan &scan) {
    SecondScanner &second = locate_.second;
    if (!scan.second || builder.map.isEmpty() || !place_.isKnown())
        return;
    const auto leaveOut = [this, &scan] {
        builder.beside.clear();
        builder.find(scan.points, located_.expected.pose());
    };
    if (!isMatched() && !builder.beside.empty()) // as it may be its fault
        leaveOut();
    const auto contradicted = [this, &scan, &second] { // which costs half a match
        return second.isShown(builder) ? 0 : fitOf(scan, true, withoutPeopleAndBeyond_).contradicted();
    };
    if (isMatched() && !second.agrees(builder, contradicted()) && !builder.beside.empty())
        leaveOut();
}

VECTORLIB_BODY PlaceFit ScanTracker::fitOf(const TimedScan &scan, bool bySecond, const PlaceFitter &by) {
    const SecondScanner &second = locate_.second;
    const Transformation2D pose(builder.report().pose);
    const bool isSecond = bySecond && scan.second;
    return search_.judge(builder.map.slots(), builder.edges(), isSecond ? second.points() : scan.points,
                         isSecond ? pose * second.mount() : pose, by);
}

VECTORLIB_BODY void ScanTracker::judge(const TimedScan &scan, const std::optional<double> &lastStamp) {
    isInterrupted_ = isInterrupted_ || located_.isInterrupted();
    isUnguided_ = isUnguided_ || located_.hasLeapt || (located_.hasPaused && !located_.byOdometry);
    if (isAfterPause_ && !isUnguided_ && !isContradicted() &&
        builder.report().outcome == ScanReport::Outcome::Lost)
        place_.place(); // as a lost scan after a pause: it may have driven on beyond the map
    if (isInterrupted_ && isMatched() && maps() && settings_.seekWhereContradicted) {
        doubt(); // it may be elsewhere, where the map is alike
        isAfterPause_ = true;
    }
    isInterrupted_ = isInterrupted_ && !isMatched();
    isAfterPause_ = isAfterPause_ && place_.state() == PlaceState::Told;
    if (maps())
        judgeBreak(scan);
    else if (isMatched())
        weigh(scan, lastStamp);
    if (isContradicted() || place_.isSought())
        builder.refuse();
}

// While the map grows: the sensor may have been carried.
VECTORLIB_BODY void ScanTracker::judgeBreak(const TimedScan &scan) {
    evidence_.forget();
    const ScanReport &report = builder.report();
    if (!settings_.seekWhereContradicted || builder.map.isEmpty() || located_.isDisputed)
        return;
    const Transformation2D pose(report.pose);
    const bool isSurprising =
        located_.byOdometry && (located_.expected.inverse() * pose).exceeds(surprising_m, surprising_rad);
    const bool isShown =
        builder.isFollowed() &&
        (!builder.isExpectedByScan() || builder.matchPair.match().agreement.explained() >= fewExplained);
    const Match &m = builder.match();
    const bool isMapped = isMatched() && located_.byOdometry && !isSurprising &&
                          m.reliability >= openReliability && m.matchedLength >= minMapped * m.visibleLength;
    const bool isPaired = builder.isExpectedByScan() || !builder.isFollowed();
    const bool isNear = located_.isWellExpected && !located_.way.exceeds(near_m, near_rad);
    break_.take(report.outcome, isNear || located_.isInterrupted(), isShown && !isSurprising, isMapped,
                isPaired && !located_.isInterrupted()
                    ? std::optional(builder.matchPair.match().agreement.contradicted())
                    : std::nullopt,
                builder.isPassedOver());
    if (break_.isTorn())
        return breakOff();
    if (break_.mayBeTorn())
        builder.refuse();
    const bool isDue = break_.isSuspect() || counts_.scans % eachNth == 0; // else it would cost half a match
    if (report.outcome == ScanReport::Outcome::Skipped || !isDue)
        return;
    const PlaceFit fit = fitOf(scan, scan.points.empty(), withoutPeople_);
    const bool isOpen = isMatched() && !builder.isFollowed() && m.reliability < openReliability;
    const bool isGuided = located_.byOdometry && !isUnguided_;
    const bool isUnknown = isOpen || (!isGuided && fit.explainedShare() < fewKnown);
    const bool isContradicted = break_.isContradicted(report.outcome, fit.hiddenShare(), isUnknown);
    isUnguided_ = isUnguided_ && break_.isSuspect();
    if (!isContradicted)
        return;
    if (lostInARow_ + 1 >= builder.settings.lostBeforeRestart)
        return breakOff();
    builder.refuse();
}

VECTORLIB_BODY void ScanTracker::breakOff() {
    builder.refuse();
    seek();
    place_.breakOff();
}

// In a finished map: the sensor may have been carried, or told a wrong place.
VECTORLIB_BODY void ScanTracker::weigh(const TimedScan &scan, const std::optional<double> &lastStamp) {
    if (!grows_ && builder.match().reliability < openReliability)
        slide(scan);
    else
        slid_.reset();
    const Pose2D &pose = builder.report().pose;
    const PlaceFit fit = fitOf(scan, scan.points.empty(), search_.fit);
    evidence_.take(fit.against(), pose, lastStamp ? std::max(0.0, scan.stamp - *lastStamp) : 0);
}

VECTORLIB_BODY void ScanTracker::slide(const TimedScan &scan) {
    const Transformation2D pose(builder.report().pose);
    WallDirections walls;
    for (const EdgeRaw2D &edge : builder.edges())
        walls.add(pose.rotate(edge.segment.normal()), edge.segment.length());
    if (walls.isEmpty() || builder.isBent())
        return;
    const Vector2D<double> along = walls.weakest();
    const std::optional<double> off =
        search_.slide(builder.map.slots(), builder.edges(), scan.points, pose, along);
    const auto before = std::exchange(slid_, std::nullopt);
    if (!off)
        return;
    const Vector2D<double> way = along * *off;
    constexpr double right_m = OpenDirection::right_m;
    if (std::abs(*off) > right_m && !(before && (way - *before).norm() <= right_m)) {
        slid_ = way;
        open_.dispute(way);
        return;
    }
    open_.place(); // nothing is open there
    if (*off == 0)
        return;
    const Transformation2D moved(way.x, way.y, 0);
    builder.move(moved);
    locate_.move(moved);
}

VECTORLIB_BODY void ScanTracker::checkOdometry(const TimedScan &scan) {
    if (!scan.odometry || !isMatched())
        return;
    const OdometryTrack &track = *scan.odometry;
    if (std::exchange(epoch_, track.epoch()) != track.epoch())
        check_.restart();
    counts_.contradicted += check_.add(scan.stamp, track.at(scan.stamp).pose(),
                                       builder.report().pose * settings_.sensorOnRobot.inverse());
}

VECTORLIB_BODY void ScanTracker::followOpen(const TimedScan &scan) {
    const bool isOpen = !isMatched() || builder.match().reliability < openReliability;
    open_.follow(Transformation2D(builder.report().pose), isOpen, located_.byOdometry, maps(), scan.odometry,
                 scan.stamp, Transformation2D(settings_.sensorOnRobot));
}

VECTORLIB_BODY void ScanTracker::seek() {
    place_.seek();
    isAfterPause_ = false;
    nextSearch_ = {};
}

VECTORLIB_BODY bool ScanTracker::wantsToConfirm() const {
    return !isPlaced_ && place_.wantsToConfirm(Transformation2D(builder.report().pose));
}

VECTORLIB_BODY void ScanTracker::claim(const Pose2D &pose) {
    place(pose);
    open_.placeAbout();
    doubt();
}

VECTORLIB_BODY void ScanTracker::place(const Pose2D &pose, double against) {
    isPlaced_ = true;
    place_.place();
    lostInARow_ = 0;
    evidence_.place(pose, against);
    locate_.place(pose);
    check_.restart();
    open_.place();
    slid_.reset();
    isAfterPause_ = isInterrupted_ = false;
    break_.place();
    builder.placed();
}

VECTORLIB_BODY void ScanTracker::placeFound(const Pose2D &pose, double against) {
    const Transformation2D expected(builder.report().pose);
    const PlaceKnowledge before = place_; // it may have broken off
    place(pose, against);
    if (!grows_)
        return;
    place_ = before;
    place_.find(Transformation2D(pose), expected);
}

VECTORLIB_BODY Relocalized ScanTracker::relocalize(bool apply) {
    if (counts_.scans == 0)
        return {};
    const Relocalized &result = search_(builder.map.slots(), builder.edges(), points_);
    if (apply && result.isFound())
        placeFound(result.places.front().pose, result.places.front().against);
    return result;
}

VECTORLIB_BODY bool ScanTracker::wantsSearch() const {
    // A growing map goes on from the expected pose after some lost scans: from then on it holds the scan
    // itself, at a place that may be wrong, and the search would find that.
    const bool holdsTheScan = draws() && lostInARow_ >= builder.settings.lostBeforeRestart;
    const bool isLost = settings_.relocalizeAfter > 0 && lostInARow_ >= settings_.relocalizeAfter;
    return place_.isSought() || wantsToConfirm() || (isLost && !holdsTheScan);
}

VECTORLIB_BODY Relocalized ScanTracker::search() {
    if (!wantsToConfirm())
        return relocalize(true);
    const Relocalized again = relocalize(false);
    place_.confirm(Transformation2D(builder.report().pose),
                   again.isFound() ? std::optional(Transformation2D(again.places.front().pose))
                                   : std::nullopt);
    return again;
}

VECTORLIB_BODY std::optional<Relocalized> ScanTracker::recover() {
    if (!wantsSearch() || Clock::now() < nextSearch_)
        return std::nullopt;
    const Relocalized result = search();
    const std::chrono::duration<double, std::milli> pause(std::max(1000.0, 10 * result.ms));
    nextSearch_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(pause);
    return result;
}

VECTORLIB_BODY void ScanTracker::correct(VectorMap &map, const Transformation2D &moved) {
    builder.correct(map, moved);
    search_.index().clear();
    locate_.move(moved);
    check_.restart();
    open_.place();
    break_.correct();
    place_.move(moved);
}

VECTORLIB_BODY void ScanTracker::clear() {
    builder.clear();
    search_.index().clear();
    lostInARow_ = 0;
    place({});
    counts_ = ScanTrackerCounts();
}

VECTORLIB_BODY TrackedBy ScanTracker::trackedBy() const {
    if (wasPlaced_)
        return TrackedBy::Placed;
    return isMatched() && wasMatched_ && located_.isWellExpected ? TrackedBy::Map
           : isByScan()                                          ? TrackedBy::Scan
           : located_.byOdometry                                 ? TrackedBy::Odometry
                                                                 : TrackedBy::Nothing;
}

VECTORLIB_BODY std::optional<PoseTrust::Features> ScanTracker::trustFeatures() const {
    const Match &m = builder.match();
    if (!isMatched() || !(m.visibleLength > 0))
        return std::nullopt;
    PoseTrust::Features f = PoseTrust::features(m, builder.expected(), builder.track.settings.finalDistance);
    const double covered = std::clamp((f[5] - fewMatched) / (1 - fewMatched), 0.0, 1.0);
    if ((located_.byOdometry || !grows_) && f[1] < openReliability)
        f[1] = std::max(f[1], coveredReliability * covered * open_.belief());
    return f;
}

VECTORLIB_BODY void ScanTracker::count(const ScanReport &report) {
    counts_.doubted += isMatched() && !builder.isFollowed();
    counts_.restarts += builder.isRestart();
    lostInARow_ = report.outcome == ScanReport::Outcome::Lost ? lostInARow_ + 1 : 0;
    ++counts_.scans;
    switch (report.outcome) {
    case ScanReport::Outcome::Matched:
        ++counts_.matched;
        break;
    case ScanReport::Outcome::Lost:
        ++counts_.lost;
        break;
    case ScanReport::Outcome::Skipped:
        ++counts_.skipped;
        break;
    }
    counts_.segmentMs += report.segmentMs;
    counts_.vectorizeMs += report.vectorizeMs;
    counts_.matchMs += report.matchMs;
    counts_.mapMs += report.mapMs;
}

} // namespace vectorlib
