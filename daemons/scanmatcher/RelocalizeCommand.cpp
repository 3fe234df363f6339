#include "common/Log.h"
#include "daemons/scanmatcher/ScanMatcher.h"
#include "protocol/wire/Fields.h"

namespace hermes::scanmatcher {

using vectorlib::Relocalized;

namespace {

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
    worker_->post([this, apply, reply] {
        const Relocalized found = map_->relocalize(apply);
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

} // namespace hermes::scanmatcher
