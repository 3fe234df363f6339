#include "vectorlib/mapping/ScanLocator.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY LocatedScan ScanLocator::operator()(MapBuilder &builder, TimedScan &scan,
                                                   OpenDirection &open) {
    const double begin = scan.begin(), end = scan.end();
    middle_ = middleTime(scan.seconds);
    scan.stamp += double(middle_);
    raw_ = scan.points;
    if (scan.second)
        second.begin(*scan.second);
    const Guess byMotion{motion_.predict(scan.stamp),
                         motion_.twist(),
                         !lastStamp_ || isLastWithin(moment, scan.stamp),
                         false,
                         {}};
    Guess guess = byMotion;
    if (scan.odometry) {
        guess.twist = odometry_.twist(*scan.odometry, begin, end);
        if (const auto expected = odometry_.expect(*scan.odometry, scan.stamp))
            guess = {expected->pose, guess.twist, true, true, expected->deviations};
    }
    LocatedScan located;
    located.expected = Transformation2D(guess.pose);
    located.way = Transformation2D(builder.report().pose).inverse() * located.expected;
    located.isOdometryKnown = guess.byOdometry;
    located.isWellExpected = isLastWithin(followed_s, scan.stamp);
    const double since = lastStamp_ ? scan.stamp - *lastStamp_ : 0;
    located.hasPaused = lastStamp_ && std::abs(since) > std::max(moment, pauses * period_);
    located.hasLeapt = located.way.exceeds(leap_m + fastest_mps * std::max(since, 0.0),
                                           leap_rad + fastest_radps * std::max(since, 0.0)) &&
                       lastStamp_;
    Found found = find(builder, scan, guess);
    const bool isClose = isLastWithin(moment, scan.stamp) && !located.way.exceeds(close_m, close_rad);
    const bool isGuided = guess.byOdometry && isClose && found.score > 0;
    if (!(isGuided && goesByOdometry(builder, scan, guess, located, open, found)) && scan.odometry &&
        (found.score < 0 || (isStraightened(scan) && (found.again || leaps(byMotion, guess, end - begin))))) {
        const Found other = find(builder, scan, byMotion);
        const bool better = other.score > muchBetter * found.score || (other.straight && !found.straight);
        if (other.score > 0 && better) {
            located.isStraight = other.straight;
            return located;
        }
        found = find(builder, scan, guess);
    }
    located.byOdometry = guess.byOdometry;
    located.isWellExpected = located.isWellExpected || guess.byOdometry;
    located.isStraight = found.straight;
    return located;
}

VECTORLIB_BODY void ScanLocator::update(const Pose2D &pose, const TimedScan &scan) {
    motion_.update(pose, scan.stamp);
    if (scan.odometry)
        odometry_.update(pose, *scan.odometry, scan.stamp);
    if (lastStamp_ && scan.stamp > *lastStamp_) // one pause does not make it long
        period_ = period_ > 0 ? std::min(scan.stamp - *lastStamp_, 2 * period_) : scan.stamp - *lastStamp_;
    lastStamp_ = scan.stamp;
}

VECTORLIB_BODY void ScanLocator::place(const Pose2D &pose) {
    motion_.reset(pose);
    odometry_.reset();
    lastStamp_.reset();
}

VECTORLIB_BODY bool ScanLocator::goesByOdometry(MapBuilder &builder, TimedScan &scan, const Guess &guess,
                                                LocatedScan &located, OpenDirection &open, Found &found) {
    const double way = located.way.translation().norm(),
                 errs = odometryErrs * ((guess.deviations ? guess.deviations->xy : leastErr_m) +
                                        std::max(errsByWay, open.slip()) * way);
    const Transformation2D pose(builder.report().pose);
    const Vector2D<double> off = pose.translation() - located.expected.translation();
    if (off.norm() <= errs)
        return false;
    const WallDirections known = knownWalls(builder);
    const Vector2D<double> along = known.weakest();
    located.isDisputed = !known.isEmpty() && known.reliability() <= OpenDirection::openReliability &&
                         std::abs(along.dot(off)) > errs;
    if (located.isDisputed)
        open.dispute(along * along.dot(off));
    const Found other = findByOdometry(builder, scan, guess);
    const bool isMoreKnown = other.score > 0 && knownWalls(builder).weight() > muchMore * known.weight();
    const bool isTaken = located.isDisputed || isMoreKnown;
    found = isTaken ? other : find(builder, scan, guess);
    return isTaken;
}

VECTORLIB_BODY WallDirections ScanLocator::knownWalls(const MapBuilder &builder) {
    WallDirections known;
    for (const CorrespondencePair &pair : builder.match().pairs) {
        const MapEdge &wall = builder.map.slots()[std::size_t(builder.candidates()[std::size_t(pair.fixed)])];
        if (wall.observations >= knownForLong)
            known.add(wall.segment.normal(), builder.edges()[std::size_t(pair.moving)].segment.length());
    }
    return known;
}

VECTORLIB_BODY ScanLocator::Found ScanLocator::findByOdometry(MapBuilder &builder, TimedScan &scan,
                                                              const Guess &guess) {
    builder.settings.matchPrevious = false;
    builder.settings.leastObservations = knownForLong;
    const Found found = find(builder, scan, guess);
    builder.settings.matchPrevious = true;
    builder.settings.leastObservations = 0;
    return found;
}

VECTORLIB_BODY ScanLocator::Found ScanLocator::find(MapBuilder &builder, TimedScan &scan,
                                                    const Guess &guess) {
    tellHowSure(builder, guess);
    Found found;
    Twist2D twist = guess.twist;
    for (int tries = 1;; ++tries) {
        if (isStraightened(scan)) {
            scan.points = raw_;
            vectorlib::compensateMotion(scan.points, scan.seconds, middle_, twist);
        }
        takeBeside(builder, scan, twist);
        const ScanReport &report = builder.find(scan.points, guess.pose);
        if (report.outcome != ScanReport::Outcome::Matched)
            return {tries == 1, tries > 1, report.outcome == ScanReport::Outcome::Lost ? -1.0 : 0.0};
        if (!isStraightened(scan))
            break;
        const TwistCorrection::Result wrong = twistError(builder, scan);
        found.straight = wrong.bend <= straight_m;
        found.again = tries > 1 || !found.straight;
        if (found.straight || tries == maxTries)
            break;
        twist = {twist.vx + wrong.twist.vx, twist.vy + wrong.twist.vy, twist.omega + wrong.twist.omega};
    }
    const double apart = builder.match().rms / builder.track.settings.finalDistance;
    found.score = builder.match().matchedLength * (1 - apart * apart);
    return found;
}

VECTORLIB_BODY void ScanLocator::takeBeside(MapBuilder &builder, const TimedScan &scan,
                                            const Twist2D &twist) {
    builder.beside.clear();
    if (!scan.second)
        return;
    const double begin = std::min(scan.second->begin(), scan.stamp),
                 end = std::max(scan.second->end(), scan.stamp);
    const Twist2D way = scan.odometry ? odometry_.twist(*scan.odometry, begin, end) : twist;
    second.bring(*scan.second, scan.stamp, way, builder.extract);
    if (second.isTaken() && !builder.map.isEmpty()) // it never defines the map
        builder.beside = second.edges();
}

VECTORLIB_BODY TwistCorrection::Result ScanLocator::twistError(const MapBuilder &builder,
                                                               const TimedScan &scan) {
    const Transformation2D toSensor = Transformation2D(builder.report().pose).inverse();
    known_.clear();
    for (const LineSegment2D<double> &edge : builder.known()) {
        const LineSegment2D<double> seen = toSensor * edge;
        if (seen.across({0, 0}) > 0) // its front
            known_.push_back(seen);
    }
    return correct_(scan.points, scan.seconds, middle_, known_);
}

VECTORLIB_BODY bool ScanLocator::leaps(const Guess &a, const Guess &b, double seconds) {
    const auto isFar = [](const Pose2D &from, const Pose2D &to) {
        return Transformation2D(from.inverse() * to).exceeds(leap_m, leap_rad);
    };
    return isFar(a.pose, b.pose) || isFar(a.twist.motion(seconds), b.twist.motion(seconds));
}

VECTORLIB_BODY void ScanLocator::tellHowSure(MapBuilder &builder, const Guess &guess) const {
    TrackingSettings &track = builder.track.settings;
    track = guess.well ? tracking : poorly(tracking);
    ScanPairSettings &pair = builder.matchPair.settings;
    pair = guess.well ? ScanPairSettings() : ScanPairSettings::forPoorExpectation();
    if (!guess.deviations)
        return;
    track.expectedDeviationXY = guess.deviations->xy;
    track.expectedDeviationAlpha = guess.deviations->alpha;
}

VECTORLIB_BODY TrackingSettings ScanLocator::poorly(const TrackingSettings &well) {
    TrackingSettings s = well;
    const TrackingSettings poor = TrackingSettings::forPoorExpectation();
    s.permitted = {std::max(s.permitted.dx, poor.permitted.dx), std::max(s.permitted.dy, poor.permitted.dy),
                   std::max(s.permitted.dalpha, poor.permitted.dalpha)};
    s.expectedDeviationXY = std::max(s.expectedDeviationXY, poor.expectedDeviationXY);
    s.expectedDeviationAlpha = std::max(s.expectedDeviationAlpha, poor.expectedDeviationAlpha);
    s.minMatchedShare = std::max(s.minMatchedShare, poor.minMatchedShare);
    return s;
}

} // namespace vectorlib
