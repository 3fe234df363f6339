#include "common/Log.h"
#include "common/Time.h"
#include "daemons/scanmatcher/ScanMatcher.h"
#include "protocol/wire/Fields.h"

namespace hermes::scanmatcher {

using vectorlib::Relocalized;
using PlaceState = vectorlib::ScanTracker::PlaceState;

namespace {

constexpr double longestBlindness_s = 3;

QString text(const Pose2D &pose) {
    return QString("x %1 m, y %2 m, theta %3 rad")
        .arg(pose.x, 0, 'f', 2)
        .arg(pose.y, 0, 'f', 2)
        .arg(pose.theta, 0, 'f', 2);
}

} // namespace

void ScanMatcher::declareRelocalization() {
    addCommand(
        Command("pose.relocalize",
                "Finds the last scan in the whole map, wherever the sensor was expected, and takes its place "
                "over. Where several places fit alike, or none, the pose stays; data.candidates has the best")
            .param(Field::boolean("apply", "Take the pose over; false: only tell it").byDefault(true))
            .gives<RelocalizeAnswer>()
            .asyncHandler(
                [this](const Call &call, const Reply &reply) { relocalize(call.flag("apply"), reply); }));
}

void ScanMatcher::relocalize(bool apply, const Reply &reply) {
    if (relocalizing_) // calls that pile up would keep the scans waiting
        return reply.error({ErrorCode::NotReady, "another search of the map is under way"});
    relocalizing_ = true;
    worker_->post([this, apply, reply](vectorlib::ScanTracker &tracker) {
        const Relocalized found = tracker.relocalize(apply);
        place_ = tracker.placeState();
        QMetaObject::invokeMethod(this, [this, apply, found, reply] {
            relocalizing_ = false;
            RelocalizeAnswer answer;
            answer.search = answerOf(found);
            if (!found.isFound())
                return reply.error({ErrorCode::NotReady,
                                    "the pose stays: " + QString::fromStdString(found.text()),
                                    asJson(answer.search)});
            answer.place = answer.search.candidates.front();
            answer.applied = apply;
            reply.result(asJson(answer));
        });
    });
}

// After a scan; searches the whole map when it is time to. What waits for a place goes on when it is found.
std::optional<Relocalized> ScanMatcher::find(vectorlib::ScanTracker &tracker) {
    const std::optional<Relocalized> found = tracker.recover();
    place_ = tracker.placeState();
    if (found && !found->isFound() && newMap_ == NewMap::WhenNowhere) {
        newMap_ = NewMap::Due; // not now: what the scan gave is to be told
        QMetaObject::invokeMethod(this, [this] {
            if (worker_)
                worker_->post([this](vectorlib::ScanTracker &now) { beginReplayAnew(now); });
        });
    }
    return found;
}

// Until it is found or told, scans count as lost.
void ScanMatcher::seek(vectorlib::ScanTracker &tracker, NewMap newMap) {
    newMap_ = newMap;
    tracker.seek();
    place_ = tracker.placeState();
}

void ScanMatcher::showRecovery(const Relocalized &recovery) {
    ++recoveries_;
    recovered_ += recovery.isFound();
    if (recovery.isFound())
        logInfo("tracking", QString("found in the whole map after %1 lost scans: %2")
                                .arg(lostInARow_)
                                .arg(text(recovery.places.front().pose)));
    else if (!lastRecovery_ || lastRecovery_->outcome != recovery.outcome)
        logWarning("tracking", QString("not found in the whole map after %1 lost scans: %2")
                                   .arg(lostInARow_)
                                   .arg(QString::fromStdString(recovery.text())));
    lastRecovery_ = recovery;
}

void ScanMatcher::noteSkipped(const Outcome &outcome) {
    if (outcome.outcome != vectorlib::ScanReport::Outcome::Skipped) {
        skipped_ = {};
        return;
    }
    if (skipped_.count++ == 0)
        skipped_.since = monotonicNow();
    skipped_.segments = outcome.result.segments.size();
    skipped_.points = outcome.points;
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
    QString message = lostInARow_ > 0 ? QString("lost for %1 scans").arg(lostInARow_)
                      : isBlind()     ? blindText()
                                      : QString("on track");
    if (lastRecovery_)
        message += "; the whole map was searched: " + QString::fromStdString(lastRecovery_->text());
    const PlaceState place = place_;
    if (place == PlaceState::Told)
        message += "; the scans do not confirm the place that was told: nothing is mapped until they do, or "
                   "pose.set insists with confirm";
    else if (place == PlaceState::Found && mapping_)
        message += "; the place was found in the map: nothing is mapped until a second search, a metre on, "
                   "agrees";
    else if (place == PlaceState::Sought)
        message += "; the place in the map is sought: until it is found scans count as lost and nothing is "
                   "mapped. Drive to where the map shows the same, or tell the place with pose.set";
    const HealthLevel level =
        lostInARow_ >= 3 ? HealthLevel::Failed
        : isBlind() || (place != PlaceState::Known && (mapping_ || place == PlaceState::Sought))
            ? HealthLevel::Warn
            : HealthLevel::Ok;
    health().set("tracking", level, message,
                 {{"lost_in_a_row", lostInARow_},
                  {"skipped_in_a_row", skipped_.count},
                  {"recoveries", qint64(recoveries_)},
                  {"recovered", qint64(recovered_)}});
}

} // namespace hermes::scanmatcher
