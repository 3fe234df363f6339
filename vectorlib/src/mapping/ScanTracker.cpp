#include "vectorlib/mapping/ScanTracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vectorlib {

VECTORLIB_BODY void ScanTracker::apply(const ScanTrackerSettings &settings) {
    settings_ = settings;
    builder.settings.matchPrevious = true;
    builder.settings.tracking = settings.tracking;
    odometry_.setMount(settings.sensorOnRobot);
    check_.restart(); // with another mount the robot is elsewhere
    scanner_ = ScannerCheck();
    search_.maxSeconds = settings.relocalizeSeconds;
}

VECTORLIB_BODY const ScanReport &ScanTracker::process(TimedScan &scan) {
    if (!settings_.useOdometry)
        scan.odometry.reset();
    const double begin = scan.begin(), end = scan.end();
    middle_ = middleTime(scan.seconds);
    scan.stamp += double(middle_);
    raw_ = scan.points;
    wasPlaced_ = std::exchange(isPlaced_, false);
    wasMatched_ = builder.report().outcome == ScanReport::Outcome::Matched;
    const Transformation2D before(builder.report().pose);
    EarSettings scanner = EarSettings::forScanner(scan.fieldOfView, scan.rays);
    scanner.closed = scan.closed;
    builder.extract.segment.settings = segmentation ? segmentation(scanner) : scanner;
    straight_ = locate(scan, begin, end);
    checkScanner(before, scan.stamp);
    judge(scan);
    const ScanReport &report = builder.conclude(scan.points, straight_);
    points_ = scan.points;
    motion_.update(report.pose, scan.stamp);
    if (scan.odometry)
        odometry_.update(report.pose, *scan.odometry, scan.stamp);
    if (scan.odometry && report.outcome == ScanReport::Outcome::Matched)
        check(*scan.odometry, scan.stamp);
    followOpen(scan);
    lastStamp_ = scan.stamp;
    count(report);
    settle();
    return report;
}

VECTORLIB_BODY void ScanTracker::followOpen(const TimedScan &scan) {
    const bool isOpen = builder.report().outcome != ScanReport::Outcome::Matched ||
                        builder.match().reliability < openReliability;
    open_.follow(Transformation2D(builder.report().pose), isOpen, byOdometry_, scan.odometry, scan.stamp,
                 Transformation2D(settings_.sensorOnRobot));
}

VECTORLIB_BODY void ScanTracker::check(const OdometryTrack &track, double stamp) {
    if (std::exchange(epoch_, track.epoch()) != track.epoch())
        check_.restart();
    counts_.contradicted +=
        check_.add(stamp, track.at(stamp).pose(), builder.report().pose * settings_.sensorOnRobot.inverse());
}

VECTORLIB_BODY void ScanTracker::checkScanner(const Transformation2D &before, double stamp) {
    if (isOdometryGuess_ && lastStamp_ && wasMatched_ && builder.isExpectedByScan() &&
        builder.matchPair.match().linesSuffice)
        scanner_.add(guessedWay_, before.inverse() * builder.expected(), stamp - *lastStamp_);
}

VECTORLIB_BODY void ScanTracker::judge(const TimedScan &scan) {
    const bool isMatched = builder.report().outcome == ScanReport::Outcome::Matched;
    if (builder.settings.grow)
        judgeBreak(scan);
    else if (isMatched)
        weigh(scan);
    if (isContradicted() || place_ == PlaceState::Sought)
        builder.refuse();
}

// The sensor may have been carried.
VECTORLIB_BODY void ScanTracker::judgeBreak(const TimedScan &scan) {
    evidence_.forget();
    const ScanReport &report = builder.report();
    if (!settings_.seekWhereContradicted || builder.map.isEmpty() || isDisputed_)
        return;
    const Transformation2D pose(report.pose);
    const bool isSurprising = byOdometry_ && isFar(guessed_.inverse() * pose, surprising_m, surprising_rad);
    const bool isShown =
        builder.isFollowed() &&
        (!builder.isExpectedByScan() || builder.matchPair.match().agreement.explained() >= fewExplained);
    const bool isPaired = builder.isExpectedByScan() || !builder.isFollowed();
    break_.take(report.outcome, isWellExpected_ && !isFar(guessedWay_, near_m, near_rad),
                isShown && !isSurprising,
                isPaired ? std::optional(builder.matchPair.match().agreement.contradicted()) : std::nullopt);
    if (break_.isTorn())
        return breakOff();
    if (break_.mayBeTorn())
        builder.refuse();
    const bool isDue = break_.isSuspect() || counts_.scans % eachNth == 0; // else it would cost half a match
    if (report.outcome == ScanReport::Outcome::Skipped || !isDue)
        return;
    const PlaceFit fit =
        search_.judge(builder.map.slots(), builder.edges(), scan.points, pose, withoutPeople_);
    const bool isUnknown = !byOdometry_ && fit.explainedShare() < fewKnown;
    if (!break_.isContradicted(report.outcome, fit.hiddenShare(), isUnknown))
        return;
    if (lostInARow_ + 1 >= builder.settings.lostBeforeRestart)
        return breakOff();
    builder.refuse();
}

VECTORLIB_BODY void ScanTracker::breakOff() {
    builder.refuse();
    seek();
    isBent_ = true;
}

VECTORLIB_BODY void ScanTracker::weigh(const TimedScan &scan) {
    const Pose2D &pose = builder.report().pose;
    const PlaceFit fit =
        search_.judge(builder.map.slots(), builder.edges(), scan.points, Transformation2D(pose), search_.fit);
    const double since_s = lastStamp_ ? std::max(0.0, scan.stamp - *lastStamp_) : 0;
    evidence_.take(fit.against(), pose, since_s);
}

VECTORLIB_BODY void ScanTracker::setPlace(PlaceState place) {
    place_ = place;
    builder.settings.grow = grows_ && place == PlaceState::Known;
}

VECTORLIB_BODY void ScanTracker::seek() {
    setPlace(PlaceState::Sought);
    isBent_ = false;
    nextSearch_ = {};
}

VECTORLIB_BODY void ScanTracker::settle() {
    const bool isMatched = builder.report().outcome == ScanReport::Outcome::Matched;
    agreed_ = isMatched && agrees() ? agreed_ + 1 : 0;
    if ((place_ == PlaceState::Told && agreed_ >= enoughToAgree) ||
        (place_ == PlaceState::Found && isBent_ && agreed_ > 0))
        setPlace(PlaceState::Known);
}

VECTORLIB_BODY bool ScanTracker::wantsToConfirm() const {
    return place_ == PlaceState::Found && agreed_ > 0 && !isPlaced_ &&
           isFar(foundAt_.inverse() * Transformation2D(builder.report().pose), confirmed_m, confirmed_rad);
}

VECTORLIB_BODY void ScanTracker::confirm(const Relocalized &again) {
    foundAt_ = Transformation2D(builder.report().pose);
    if (!again.isFound())
        return;
    if (isFar(foundAt_.inverse() * Transformation2D(again.places.front().pose), same_m, same_rad))
        seek();
    else
        setPlace(PlaceState::Known);
}

VECTORLIB_BODY void ScanTracker::claim(const Pose2D &pose) {
    place(pose);
    doubt();
}

VECTORLIB_BODY void ScanTracker::place(const Pose2D &pose, double against) {
    isPlaced_ = true;
    setPlace(PlaceState::Known);
    agreed_ = 0;
    lostInARow_ = 0;
    evidence_.place(pose, against);
    motion_.reset(pose);
    odometry_.reset();
    check_.restart();
    open_.place();
    break_.place();
    builder.placed();
    lastStamp_.reset();
}

VECTORLIB_BODY Relocalized ScanTracker::relocalize(bool apply) {
    if (counts_.scans == 0)
        return {};
    const Transformation2D expected(builder.report().pose);
    const Relocalized &result = search_(builder.map.slots(), builder.edges(), points_);
    if (!apply || !result.isFound())
        return result;
    place(result.places.front().pose, result.places.front().against);
    if (!grows_)
        return result;
    setPlace(PlaceState::Found);
    foundAt_ = Transformation2D(result.places.front().pose);
    isBent_ = isBent_ && !isFar(expected.inverse() * foundAt_, bend_m, bend_rad);
    return result;
}

VECTORLIB_BODY bool ScanTracker::wantsSearch() const {
    // A growing map goes on from the expected pose after some lost scans: from then on it holds the scan
    // itself, at a place that may be wrong, and the search would find that.
    const bool holdsTheScan = builder.settings.grow && lostInARow_ >= builder.settings.lostBeforeRestart;
    const bool isLost = settings_.relocalizeAfter > 0 && lostInARow_ >= settings_.relocalizeAfter;
    return place_ == PlaceState::Sought || wantsToConfirm() || (isLost && !holdsTheScan);
}

VECTORLIB_BODY Relocalized ScanTracker::search() {
    if (!wantsToConfirm())
        return relocalize(true);
    const Relocalized again = relocalize(false);
    confirm(again);
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
    motion_.move(moved);
    odometry_.move(moved);
    check_.restart();
    open_.place();
    break_.correct();
    foundAt_ = moved * foundAt_;
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
    const bool isMatched = builder.report().outcome == ScanReport::Outcome::Matched;
    return isMatched && wasMatched_ && isWellExpected_ ? TrackedBy::Map
           : isByScan()                                ? TrackedBy::Scan
           : byOdometry_                               ? TrackedBy::Odometry
                                                       : TrackedBy::Nothing;
}

VECTORLIB_BODY std::optional<PoseTrust::Features> ScanTracker::trustFeatures() const {
    const Match &m = builder.match();
    if (builder.report().outcome != ScanReport::Outcome::Matched || !(m.visibleLength > 0))
        return std::nullopt;
    PoseTrust::Features f = PoseTrust::features(m, builder.expected(), builder.track.settings.finalDistance);
    const double covered = std::clamp((f[5] - fewMatched) / (1 - fewMatched), 0.0, 1.0);
    if (byOdometry_ && f[1] < openReliability)
        f[1] = std::max(f[1], coveredReliability * covered * open_.belief());
    return f;
}

VECTORLIB_BODY bool ScanTracker::locate(TimedScan &scan, double begin, double end) {
    const Guess byMotion{motion_.predict(scan.stamp),
                         motion_.twist(),
                         !lastStamp_ || isMomentAgo(*lastStamp_, scan.stamp),
                         false,
                         {}};
    Guess guess = byMotion;
    if (scan.odometry) {
        guess.twist = odometry_.twist(*scan.odometry, begin, end);
        if (const auto expected = odometry_.expect(*scan.odometry, scan.stamp))
            guess = {expected->pose, guess.twist, true, true, expected->deviations};
    }
    guessed_ = Transformation2D(guess.pose);
    guessedWay_ = Transformation2D(builder.report().pose).inverse() * guessed_;
    isOdometryGuess_ = guess.byOdometry;
    byOdometry_ = false;
    isWellExpected_ = lastStamp_ && scan.stamp > *lastStamp_ && scan.stamp - *lastStamp_ <= followed_s;
    Found found = find(scan, guess);
    const bool isClose =
        lastStamp_ && isMomentAgo(*lastStamp_, scan.stamp) && !isFar(guessedWay_, close_m, close_rad);
    const auto off = guess.byOdometry && isClose ? disputed(guess) : std::nullopt;
    isDisputed_ = off.has_value();
    if (isDisputed_) {
        open_.dispute(*off);
        byOdometry_ = isWellExpected_ = true;
        ++counts_.byOdometry;
        return findByOdometry(scan, guess).straight;
    }
    const bool doubtful = found.again || leaps(byMotion, guess, end - begin);
    if (scan.odometry && (found.score < 0 || (isStraightened(scan) && doubtful))) {
        const Found other = find(scan, byMotion);
        const bool better = other.score > muchBetter * found.score || (other.straight && !found.straight);
        if (other.score > 0 && better)
            return other.straight;
        found = find(scan, guess);
    }
    byOdometry_ = guess.byOdometry;
    isWellExpected_ = isWellExpected_ || guess.byOdometry;
    counts_.byOdometry += byOdometry_;
    return found.straight;
}

VECTORLIB_BODY std::optional<Vector2D<double>> ScanTracker::disputed(const Guess &guess) {
    const Transformation2D pose(builder.report().pose);
    const Vector2D<double> off = pose.translation() - Transformation2D(guess.pose).translation();
    const double errs = (guess.deviations ? guess.deviations->xy : leastErr_m) +
                        std::max(errsByWay, open_.slip()) * guessedWay_.translation().norm();
    if (builder.report().outcome != ScanReport::Outcome::Matched || off.norm() < odometryErrs * errs)
        return std::nullopt;
    WallDirections known; // for long
    for (const CorrespondencePair &pair : builder.match().pairs) {
        const MapEdge &wall = builder.map.slots()[std::size_t(builder.candidates()[std::size_t(pair.fixed)])];
        if (wall.observations >= knownForLong)
            known.add(wall.segment.normal(), builder.edges()[std::size_t(pair.moving)].segment.length());
    }
    if (known.isEmpty() || known.reliability() > openReliability)
        return std::nullopt;
    const Vector2D<double> open = known.weakest();
    const double along = open.dot(off);
    return std::abs(along) > odometryErrs * errs ? std::optional(open * along) : std::nullopt;
}

VECTORLIB_BODY ScanTracker::Found ScanTracker::findByOdometry(TimedScan &scan, const Guess &guess) {
    builder.settings.matchPrevious = false;
    builder.settings.leastObservations = knownForLong;
    const Found found = find(scan, guess);
    builder.settings.matchPrevious = true;
    builder.settings.leastObservations = 0;
    return found;
}

VECTORLIB_BODY ScanTracker::Found ScanTracker::find(TimedScan &scan, const Guess &guess) {
    tellHowSure(guess);
    Found found;
    Twist2D twist = guess.twist;
    for (int tries = 1;; ++tries) {
        if (isStraightened(scan)) {
            scan.points = raw_;
            compensateMotion(scan.points, scan.seconds, middle_, twist);
        }
        const ScanReport &report = builder.find(scan.points, guess.pose);
        if (report.outcome != ScanReport::Outcome::Matched)
            return {tries == 1, tries > 1, report.outcome == ScanReport::Outcome::Lost ? -1.0 : 0.0};
        if (!isStraightened(scan))
            break;
        const TwistCorrection::Result wrong = twistError(scan);
        found.straight = wrong.bend <= straight_m;
        found.again = tries > 1 || !found.straight;
        if (found.straight || tries == mostTries)
            break;
        twist = {twist.vx + wrong.twist.vx, twist.vy + wrong.twist.vy, twist.omega + wrong.twist.omega};
    }
    const double apart = builder.match().rms / builder.track.settings.finalDistance;
    found.score = builder.match().matchedLength * (1 - apart * apart);
    return found;
}

VECTORLIB_BODY TwistCorrection::Result ScanTracker::twistError(const TimedScan &scan) {
    const Transformation2D toSensor = Transformation2D(builder.report().pose).inverse();
    known_.clear();
    for (const LineSegment2D<double> &edge : builder.known()) {
        const LineSegment2D<double> seen = toSensor * edge;
        if (seen.across({0, 0}) > 0) // its front
            known_.push_back(seen);
    }
    return correct_(scan.points, scan.seconds, middle_, known_);
}

VECTORLIB_BODY bool ScanTracker::leaps(const Guess &a, const Guess &b, double seconds) {
    const auto isFar = [](const Pose2D &from, const Pose2D &to) {
        const Pose2D way = from.inverse() * to;
        return std::hypot(way.x, way.y) > leap_m || std::abs(way.theta) > leap_rad;
    };
    return isFar(a.pose, b.pose) || isFar(a.twist.motion(seconds), b.twist.motion(seconds));
}

VECTORLIB_BODY void ScanTracker::tellHowSure(const Guess &guess) {
    TrackingSettings &track = builder.track.settings;
    track = guess.well ? settings_.tracking : poorly(settings_.tracking);
    ScanPairSettings &pair = builder.matchPair.settings;
    pair = guess.well ? ScanPairSettings() : ScanPairSettings::forPoorExpectation();
    pair.leavesOpen = guess.byOdometry;
    if (!guess.deviations)
        return;
    track.expectedDeviationXY = guess.deviations->xy;
    track.expectedDeviationAlpha = guess.deviations->alpha;
}

VECTORLIB_BODY TrackingSettings ScanTracker::poorly(const TrackingSettings &well) {
    TrackingSettings s = well;
    const TrackingSettings poor = TrackingSettings::forPoorExpectation();
    s.permitted = {std::max(s.permitted.dx, poor.permitted.dx), std::max(s.permitted.dy, poor.permitted.dy),
                   std::max(s.permitted.dalpha, poor.permitted.dalpha)};
    s.expectedDeviationXY = std::max(s.expectedDeviationXY, poor.expectedDeviationXY);
    s.expectedDeviationAlpha = std::max(s.expectedDeviationAlpha, poor.expectedDeviationAlpha);
    s.minMatchedShare = std::max(s.minMatchedShare, poor.minMatchedShare);
    return s;
}

VECTORLIB_BODY void ScanTracker::count(const ScanReport &report) {
    counts_.doubted += report.outcome == ScanReport::Outcome::Matched && !builder.isFollowed();
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
