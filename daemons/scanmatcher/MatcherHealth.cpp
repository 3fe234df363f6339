#include "common/Log.h"
#include "common/Time.h"
#include "daemons/scanmatcher/ScanMatcher.h"
#include "protocol/wire/Fields.h"

namespace hermes::scanmatcher {

using PlaceState = vectorlib::PlaceState;

namespace {

constexpr double longestSilence_s = 3, longestBlindness_s = 3, longestDoubt_s = 3;
constexpr double longestMissing_s = 1; // the second scanner
constexpr int mayBeApart = 3;          // of its scans in a row
constexpr double longestStep_s = 10;   // between scans in a row
constexpr double doubtful = 0.5;       // trust; as in the window

} // namespace

void ScanMatcher::updateHealth() {
    const auto [level, found] = source_.find(longestSilence_s);
    health().set("source", active_ ? level : HealthLevel::Ok, active_ ? found : QString("not matching"));
    updateSecondHealth();
    health().set("replay", replayed_ ? HealthLevel::Warn : HealthLevel::Ok,
                 !replayed_ ? QString("live scans are matched")
                 : map_ && map_->keepsLiveMap()
                     ? QString("a replay is matched, in a map of its own; the live map is kept, with its "
                               "drive, until live scans come")
                     : QString("a replay is matched"));
    odometry_.report(health());
    const quint64 dropped = source_.state().dropped + (worker_ ? worker_->dropped() : 0);
    health().set("queue", pastDrops_.level(double(dropped)),
                 dropped ? QString("%1 scans were dropped").arg(dropped) : QString("no scan dropped"),
                 asJson(matcherState()).toObject());
    updateTrackingHealth();
    updateSensorHealth();
    updateMemoryHealth();
    updateJournalHealth();
    updateMapHealth();
}

// What would be gone if this program ended now; empty: nothing.
QString ScanMatcher::unsavedText() const {
    const MapMirror &map = liveView_ ? liveView_->map : mirror_;
    if (map.isSaved())
        return {};
    const JournalState journal = corrector_ ? corrector_->state().journal : JournalState();
    return QString("the map of %1 segments is in no file").arg(map.size()) +
           (journal.path.isEmpty() ? QString() : "; its drive is in " + journal.path);
}

void ScanMatcher::updateMapHealth() {
    const QString unsaved = unsavedText();
    health().set("map", HealthLevel::Ok,
                 unsaved.isEmpty()
                     ? QString("nothing to save")
                     : unsaved + (liveView_ ? "; while a replay is mapped, map.save writes that of the replay"
                                            : "; map.save writes it"),
                 {{"segments", qint64(mirror_.size())}, {"saved", unsaved.isEmpty()}});
}

void ScanMatcher::updateSecondHealth() {
    if (settings().text("source2.address").isEmpty())
        return health().remove("source2");
    const auto set = [this](HealthLevel level, const QString &message) {
        health().set("source2", level, message);
    };
    const auto [level, found] = secondSource_.find(longestMissing_s);
    if (!active_)
        set(HealthLevel::Ok, "not matching");
    else if (secondSource_.silent_s() > longestMissing_s)
        set(HealthLevel::Warn, found + "; the first scanner is matched alone while this one is missing");
    else if (second_.apartInARow >= mayBeApart)
        set(HealthLevel::Warn, QString("its scans are left out: they are %1 s older than those of the first "
                                       "scanner, expected are %2 s at most; one is late, or a clock is wrong")
                                   .arg(second_.apart_s, 0, 'f', 2)
                                   .arg(vectorlib::TimedScan::longestApart_s));
    else if (second_.state != SecondScanner::State::Taken)
        set(HealthLevel::Warn, secondText());
    else // what was wrong before is told last
        set(level == HealthLevel::Ok ? HealthLevel::Ok : HealthLevel::Warn,
            QString("%1; %2 of its scans were taken").arg(found).arg(second_.paired));
}

QString ScanMatcher::secondText() const {
    const Pose2D told = trackerSettings().secondOnRobot;
    const QString fits = !second_.fitting ? QString()
                                          : QString("; sensor2.x_m, y_m and theta_rad tell %1, what it sees "
                                                    "fits %2")
                                                .arg(textOf(told), textOf(*second_.fitting));
    return second_.state == SecondScanner::State::OnTrial
               ? "its scans are not used yet: they are once both scanners showed the same at three places "
                 "(more after it failed), 0.1 m or 0.1 rad apart. Drive to where this one sees what the "
                 "first has seen" +
                     fits
               : "its scans are left out: they contradict the map. It is mounted otherwise than sensor2.* "
                 "tells, its stamps or t are wrong, or it is another robot's" +
                     fits;
}

void ScanMatcher::noteSecond(const ScanOutcome &outcome) {
    second_.fitting = outcome.secondFitting;
    if (std::exchange(second_.state, outcome.second) == outcome.second)
        return;
    if (outcome.second == SecondScanner::State::Taken)
        logInfo("source2", "both scanners show the same: the second is taken");
    else
        logWarning("source2", secondText());
}

void ScanMatcher::updateSensorHealth() {
    QString message = "nothing contradicts how the sensor is said to be mounted";
    const auto turned = scanner_.turned();
    if (scanner_.isMirrored())
        message =
            "the scans turn the other way than the odometry: their angles count clockwise, or the sensor "
            "hangs upside down; sensor.upside_down tells so";
    else if (turned)
        message =
            QString(
                "the scans do not go where the odometry leads: expected is a sensor.theta_rad of about %1")
                .arg(vectorlib::wrapAngle(settings().number("sensor.theta_rad") + *turned), 0, 'f', 2);
    health().set("sensor", scanner_.isMirrored() || turned ? HealthLevel::Warn : HealthLevel::Ok, message);
}

void ScanMatcher::updateMemoryHealth() {
    const MatcherState state = matcherState();
    const QString message =
        QString("the drive takes %1 of %2 MB")
            .arg(state.rememberedMb, 0, 'f', 1)
            .arg(settings().number("matcher.remember_mb"), 0, 'f', 1) +
        (state.memoryFull ? ": what is driven now is not remembered and no loop is closed; "
                            "matcher.close_loops off and on begins another drive in this map"
                          : "");
    health().set("memory", state.memoryFull ? HealthLevel::Warn : HealthLevel::Ok, message,
                 {{"remembered_mb", state.rememberedMb}});
}

void ScanMatcher::updateJournalHealth() {
    const JournalState journal = corrector_ ? corrector_->state().journal : JournalState();
    if (settings().text("map.journal").isEmpty())
        return health().set("journal", HealthLevel::Ok, "no journal is kept");
    const QString message = !journal.fault.isEmpty() ? journal.fault
                            : journal.path.isEmpty() ? QString("nothing to write yet")
                                                     : "written to " + journal.path;
    health().set("journal", journal.fault.isEmpty() ? HealthLevel::Ok : HealthLevel::Warn, message,
                 {{"path", journal.path}, {"bytes", journal.bytes}, {"scans", qint64(journal.scans)}});
}

void ScanMatcher::noteSkipped(const ScanOutcome &outcome) {
    if (outcome.outcome != vectorlib::ScanReport::Outcome::Skipped) {
        skipped_ = {};
        return;
    }
    if (skipped_.count++ == 0)
        skipped_.since = monotonicNow();
    skipped_.segments = outcome.result.segments.size();
    skipped_.points = outcome.points;
}

// Time is that of the scans; a clock that was set says nothing.
void ScanMatcher::noteTrust(const ScanResult &result) {
    const double step = doubt_.stamp ? result.stamp - *doubt_.stamp : 0;
    const bool isStep = step > 0 && step < longestStep_s;
    doubt_ = {result.stamp, result.pose.trust,
              result.pose.trust < doubtful ? doubt_.seconds + (isStep ? step : 0) : 0};
}

bool ScanMatcher::isBlind() const {
    return skipped_.count > 0 && monotonicNow() - skipped_.since > longestBlindness_s;
}

QString ScanMatcher::blindText() const {
    return QString("nothing to match for %1 s: %2 scans in a row were skipped, the last one shows %3 line "
                   "segments in %4 points, expected are %5 at least; the pose goes by %6")
        .arg(monotonicNow() - skipped_.since, 0, 'f', 0)
        .arg(skipped_.count)
        .arg(skipped_.segments)
        .arg(skipped_.points)
        .arg(vectorlib::MapBuilderSettings().minEdges)
        .arg(odometry_.state().connected ? "the odometry alone"
                                         : "the motion before that, there is no odometry");
}

void ScanMatcher::updateTrackingHealth() {
    QString message =
        lostInARow_ > 0 ? QString("lost for %1 scans").arg(lostInARow_)
        : isBlind()     ? blindText()
        : doubt_.seconds >= longestDoubt_s
            ? QString("the pose is doubtful for %1 s: its trust is %2, expected are %3 at least")
                  .arg(doubt_.seconds, 0, 'f', 0)
                  .arg(doubt_.trust, 0, 'f', 2)
                  .arg(doubtful)
            : QString("on track");
    if (lastRecovery_)
        message += "; the whole map was searched: " + QString::fromStdString(lastRecovery_->text());
    const PlaceState place = this->place();
    if (place == PlaceState::Told)
        message +=
            "; the scans do not confirm yet the place that was told, or where a pause ended: nothing is "
            "mapped until they do, or pose.set insists with confirm";
    else if (place == PlaceState::Found && mapping_)
        message += "; the place was found in the map: nothing is mapped until a second search, a metre on, "
                   "agrees";
    else if (place == PlaceState::Sought)
        message += "; the place in the map is sought: until it is found scans count as lost and nothing is "
                   "mapped. Drive to where the map shows the same, or tell the place with pose.set";
    const HealthLevel level =
        lostInARow_ >= 3 ? HealthLevel::Failed
        : isBlind() || doubt_.seconds >= longestDoubt_s ||
                (place != PlaceState::Known && (mapping_ || place == PlaceState::Sought))
            ? HealthLevel::Warn
            : HealthLevel::Ok;
    health().set("tracking", level, message,
                 {{"lost_in_a_row", lostInARow_},
                  {"trust", doubt_.trust},
                  {"skipped_in_a_row", skipped_.count},
                  {"recoveries", qint64(recoveries_)},
                  {"recovered", qint64(recovered_)}});
}

} // namespace hermes::scanmatcher
