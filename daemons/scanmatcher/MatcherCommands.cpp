#include "common/Log.h"
#include "daemons/scanmatcher/ScanMatcher.h"
#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"

namespace hermes::scanmatcher {

using vectorlib::Relocalized;

namespace {

constexpr double farthestPlace_m = 1e7; // that a map file holds

// Points alone will do.
QJsonObject scanSchema() {
    QJsonObject schema = schemaOf<ScanMessage>();
    schema["required"] = QJsonArray{"x", "y"};
    return schema;
}

// Its heading is of a full turn at most.
QJsonObject poseSchema() {
    QJsonObject schema = schemaOf<Pose2D>(), properties = schema["properties"].toObject();
    properties["theta"] = Field::angle("theta", "Heading, counter-clockwise").schema();
    schema["properties"] = properties;
    return schema;
}

Pose2D toPose(const QJsonObject &json) {
    return {json["x"].toDouble(), json["y"].toDouble(), json["theta"].toDouble()};
}

// Points of a parameter {x: [], y: []}; the message names the parameter.
Result<Scan> scanParameter(const Call &call, const char *name) {
    QJsonObject data = call.value(name).toObject();
    if (!data.contains("stamp"))
        data["stamp"] = 0;
    quint64 unknown = 0;
    auto scan = readScan(WireValue(data), unknown);
    if (!scan)
        return invalidParams({{name, QJsonValue::Undefined, "a scan {x: [], y: []}"}},
                             QString("%1: %2").arg(name, scan.error().message));
    return scan;
}

} // namespace

void ScanMatcher::declareMatcherCommands() {
    addCommand(Command("matcher.start", "Begins to match scans")
                   .param(Field::text("mode", "mapping: the map grows; localization: it stays as it is")
                              .choices({"mapping", "localization"})
                              .byDefault("mapping"))
                   .answers([this](const Call &call) { begin(call.text("mode") == "mapping"); }));
    addCommand(
        Command("matcher.stop", "Takes no more scans; pose and map stay").answers([this](const Call &) {
            pause();
        }));
    addCommand(
        Command("matcher.state", "Mode, counts of scans, waiting and dropped ones, milliseconds a scan")
            .needs(Role::Observer)
            .answers([this](const Call &) { return matcherState(); }));
    addCommand(Command("matcher.match", "Matches two scans with each other; map and pose are not touched")
                   .param(Field::schema("reference", "The scan that stands still: points counter-clockwise",
                                        scanSchema()))
                   .param(Field::schema("current", "The scan whose pose in the other's frame is wanted",
                                        scanSchema()))
                   .param(Field::schema("expected", "Where the current one is expected", poseSchema())
                              .byDefault(QJsonObject{{"x", 0}, {"y", 0}, {"theta", 0}}))
                   .takes(20000)
                   .gives<PairMatch>()
                   .asyncHandler([this](const Call &call, const Reply &reply) { matchTwo(call, reply); }));
    addCommand(Command("pose.set",
                       "Tells where the sensor is, standing still, in the map's frame. While the map "
                       "grows, nothing is mapped until some scans agree with the place")
                   .param(Field::number("x", "Position").unit("m").range(-farthestPlace_m, farthestPlace_m))
                   .param(Field::number("y", "Position").unit("m").range(-farthestPlace_m, farthestPlace_m))
                   .param(Field::angle("theta", "Heading"))
                   .param(Field::boolean("confirm",
                                         "A person has looked: the place is right, whatever the scans say")
                              .byDefault(false))
                   .returnsNull()
                   .example({{"x", 1.5}, {"y", 0}, {"theta", 1.57}}, QJsonValue())
                   .asyncHandler([this](const Call &call, const Reply &reply) {
                       const Pose2D pose = toPose(call.params);
                       worker_->post([this, pose, isSure = call.flag("confirm"), reply] {
                           map_->setPose(pose, isSure);
                           reply.result(QJsonValue());
                       });
                   }));
}

void ScanMatcher::matchTwo(const Call &call, const Reply &reply) {
    const auto reference = scanParameter(call, "reference"), current = scanParameter(call, "current");
    if (!reference || !current)
        return reply.error(reference ? current.error() : reference.error());
    const Pose2D expected = toPose(call.value("expected").toObject());
    worker_->post([reference = reference->data, current = current->data, expected, reply] {
        vectorlib::MapBuilder pair;
        pair.track.settings = vectorlib::TrackingSettings::forPoorExpectation();
        pair.extract.segment.settings = vectorlib::EarSettings::forScanner(2 * vectorlib::pi, reference.rays);
        pair.process(reference.points, {});
        pair.extract.segment.settings = vectorlib::EarSettings::forScanner(2 * vectorlib::pi, current.rays);
        const vectorlib::ScanReport report = pair.process(current.points, expected);
        const vectorlib::Match &match = pair.match();
        reply.result(
            asJson(PairMatch{match.pose.pose(), match.accepted, match.pairs.size(), match.reliability,
                             match.ambiguity, match.matchedLength, match.visibleLength, report.totalMs()}));
    });
}

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
                                .arg(textOf(recovery.places.front().pose)));
    else if (!lastRecovery_ || lastRecovery_->outcome != recovery.outcome)
        logWarning("tracking", QString("not found in the whole map after %1 lost scans: %2")
                                   .arg(lostInARow_)
                                   .arg(QString::fromStdString(recovery.text())));
    lastRecovery_ = recovery;
}

} // namespace hermes::scanmatcher
