#include "daemons/scanmatcher/ScanMatcher.h"

#include "common/Log.h"
#include "common/Time.h"

#include <Eigen/LU>

namespace hermes {

using vectorlib::Pose2D;
using vectorlib::ScanReport;
using vectorlib::ScanTracker;

namespace {

QJsonObject toJson(const Pose2D &pose) {
    return {{"x", pose.x}, {"y", pose.y}, {"theta", pose.theta}};
}

QString toText(ScanReport::Outcome outcome) {
    switch (outcome) {
    case ScanReport::Outcome::Matched:
        return "matched";
    case ScanReport::Outcome::Lost:
        return "lost";
    case ScanReport::Outcome::Skipped:
        return "skipped";
    }
    return {};
}

// Row by row, of x, y (m) and theta (rad); null where the pairs leave a direction open.
QJsonValue covariance(const vectorlib::Match &match) {
    const Eigen::FullPivLU<Eigen::Matrix3d> lu(match.information);
    if (match.pairs.empty() || !lu.isInvertible())
        return QJsonValue::Null;
    const Eigen::Matrix3d inverse = lu.inverse();
    QJsonArray result;
    for (int i = 0; i < 9; ++i)
        result.append(inverse(i / 3, i % 3));
    return result;
}

} // namespace

ScanMatcher::ScanMatcher()
    : Daemon({"scanmatcher", "Scan matcher",
              "Turns laser scans into line segments, finds the sensor's pose among those of a vector map, "
              "and lets the "
              "map grow"}) {
    files.setMaxThreadCount(1);
    declareSettings();
    declareTopics();
    declareMatcherCommands();
    declareMapCommands();
    declareRelocalization();
    connect(&source, &Client::connected, this, &ScanMatcher::updateHealth);
    connect(&source, &Client::disconnected, this, &ScanMatcher::updateHealth);
    connect(&odometry.client(), &Client::connected, this, &ScanMatcher::updateHealth);
    connect(&odometry.client(), &Client::disconnected, this, &ScanMatcher::updateHealth);
}

void ScanMatcher::declareTopics() {
    addTopic(Topic("pose", "Pose of the sensor after each scan, in the map's frame: x, y (m), theta (rad), "
                           "velocity, covariance, outcome matched, lost or skipped")
                 .schema({{"type", "object"}}));
    addTopic(Topic("segments", "Line segments of the last scan in the map's frame, [x1, y1, x2, y2] each (m)")
                 .schema({{"type", "array"}}));
    addTopic(
        Topic("map",
              "Changes of the map: edges (new or altered), removed (ids), cleared. Begins with the full "
              "map. A step of more than 1 in revision means that changes were missed: subscribe again or "
              "call map.get")
            .schema({{"type", "object"}})
            .snapshotParts([this](qint64 &cursor) { return QJsonValue(mirror.part(cursor)); }));
    addTopic(Topic("match",
                   "How the last scan was matched: correspondences [map edge, segment], reliability, "
                   "ambiguity (m^2), matched and visible length (m), milliseconds of each step")
                 .schema({{"type", "object"}}));
}

Result<void> ScanMatcher::start() {
    worker = std::make_unique<Worker>([this](ScanTracker &tracker, const Scan &scan) {
        Outcome outcome = outcomeOf(tracker, scan);
        outcome.recovery = tracker.recover();
        QMetaObject::invokeMethod(this, [this, outcome] { show(outcome); });
    });
    settingsChanged({});
    health().provide("tracking", [this] { updateHealth(); });
    setState(DaemonState::Ready);
    const QString wanted = settings().text("matcher.start");
    if (wanted != "nothing")
        begin(wanted == "mapping");
    return {};
}

void ScanMatcher::stop() {
    source.close();
    odometry.close();
    worker.reset();
    files.waitForDone();
}

void ScanMatcher::settingsChanged(const QStringList &paths) {
    if (!worker)
        return;
    worker->setQueueLimit(size_t(settings().integer("source.queue")));
    worker->post([s = trackerSettings(), sigma = settings().number("matcher.sigma_m")](ScanTracker &tracker) {
        tracker.apply(s);
        tracker.builder.extract.vectorize.settings.sigma = sigma;
    });
    if (active && !paths.filter("source.").isEmpty())
        connectToSource();
    if (active && !paths.filter("odometry.").isEmpty())
        connectToOdometry();
}

void ScanMatcher::begin(bool toMap) {
    mapping = toMap;
    worker->post([toMap](ScanTracker &tracker) { tracker.builder.settings.grow = toMap; });
    active = true;
    connectToSource();
    connectToOdometry();
    setState(DaemonState::Running);
}

void ScanMatcher::pause() {
    active = false;
    source.close();
    odometry.close();
    setState(DaemonState::Ready);
}

void ScanMatcher::connectToSource() {
    source.close();
    source.unsubscribe(subscription);
    const auto connecting = source.connectTo(settings().text("source.address"));
    if (!connecting) {
        logError("source", connecting.error().message);
        return;
    }
    subscription =
        source.subscribe(settings().text("source.topic"), {{"queue", settings().integer("source.queue")}},
                         [this](const TopicUpdate &update) { takeScan(update); });
}

void ScanMatcher::connectToOdometry() {
    const auto opened = odometry.open(settings().text("odometry.address"), settings().text("odometry.topic"));
    if (!opened)
        logError("odometry", opened.error().message);
    updateHealth();
}

void ScanMatcher::takeScan(const TopicUpdate &update) {
    lastScan = monotonicNow();
    droppedBySource = update.dropped;
    auto parsed = readScan(update.data.toObject());
    if (!parsed) {
        if (badScans++ == 0)
            logWarning("source", parsed.error().message);
        lastBadScan = parsed.error().message;
        return;
    }
    Scan scan = parsed.take();
    if (scan.partial)
        return;
    scan.data.odometry = odometry.over(scan.data.begin(), scan.data.end());
    worker->push(std::move(scan));
}

ScanMatcher::Outcome ScanMatcher::outcomeOf(ScanTracker &tracker, const Scan &scan) {
    const vectorlib::MapBuilder &builder = tracker.builder;
    const ScanReport &report = builder.report();
    const vectorlib::Match &match = builder.match();
    const vectorlib::Twist2D &twist = tracker.motion().twist();
    Outcome o;
    o.stamp = scan.data.stamp;
    o.outcome = report.outcome;
    o.counts = tracker.counts();
    o.pose = toJson(report.pose);
    o.pose["twist"] = QJsonObject{{"vx", twist.vx}, {"vy", twist.vy}, {"omega", twist.omega}};
    o.pose["covariance"] = covariance(match);
    o.pose["outcome"] = toText(report.outcome);
    o.pose["scan"] = qint64(scan.number);

    QJsonArray pairs;
    for (const vectorlib::CorrespondencePair &p : match.pairs)
        pairs.append(QJsonArray{builder.candidates()[size_t(p.fixed)], p.moving});
    o.match = {{"scan", qint64(scan.number)},
               {"accepted", match.accepted},
               {"pairs", pairs},
               {"reliability", match.reliability},
               {"ambiguity", match.ambiguity},
               {"matched_length", match.matchedLength},
               {"visible_length", match.visibleLength},
               {"rms", match.rms},
               {"ms", QJsonObject{{"segment", report.segmentMs},
                                  {"vectorize", report.vectorizeMs},
                                  {"match", report.matchMs},
                                  {"map", report.mapMs}}}};
    const vectorlib::Transformation2D pose(report.pose);
    for (const vectorlib::EdgeRaw2D &edge : builder.edges()) {
        const vectorlib::LineSegment2D<double> s = pose * edge.segment;
        o.segments.append(QJsonArray{s.begin().x, s.begin().y, s.end().x, s.end().y});
    }
    o.changes = takeChanges(tracker.builder.map);
    return o;
}

void ScanMatcher::show(const Outcome &o) {
    counts = o.counts;
    lostInARow = o.outcome == ScanReport::Outcome::Lost ? lostInARow + 1 : 0;
    if (lostInARow == 0)
        lastRecovery.reset();
    mirror.addPose({o.stamp, {o.pose["x"].toDouble(), o.pose["y"].toDouble(), o.pose["theta"].toDouble()}});
    publish("pose", o.pose, o.stamp);
    publish("match", o.match, o.stamp);
    publish("segments", o.segments, o.stamp);
    if (!o.changes.changed.empty() || !o.changes.removed.empty())
        publish("map", mirror.apply(o.changes), o.stamp);
    if (o.recovery)
        showRecovery(*o.recovery);
}

void ScanMatcher::updateHealth() {
    const QString address = settings().text("source.address");
    if (!active)
        health().set("source", HealthLevel::Ok, "not matching");
    else if (!source.isConnected())
        health().set("source", HealthLevel::Failed,
                     QString("no connection to %1: %2").arg(address, source.lastError()));
    else if (badScans > 0)
        health().set("source", HealthLevel::Warn,
                     QString("refused %1 scans, the last: %2").arg(badScans).arg(lastBadScan));
    else
        health().set("source", HealthLevel::Ok, "connected to " + address);
    odometry.report(health());
    const quint64 dropped = droppedBySource + (worker ? worker->dropped() : 0);
    health().set("queue", dropped ? HealthLevel::Warn : HealthLevel::Ok,
                 dropped ? QString("%1 scans were dropped").arg(dropped) : QString("no scan dropped"),
                 matcherState());
    updateTrackingHealth();
}

QJsonObject ScanMatcher::matcherState() const {
    const double scans = std::max<double>(1, double(counts.scans));
    return {{"active", active},
            {"mode", mapping ? "mapping" : "localization"},
            {"scans", qint64(counts.scans)},
            {"matched", qint64(counts.matched)},
            {"lost", qint64(counts.lost)},
            {"skipped", qint64(counts.skipped)},
            {"waiting", qint64(worker ? worker->waiting() : 0)},
            {"dropped", qint64(worker ? worker->dropped() : 0)},
            {"dropped_by_source", qint64(droppedBySource)},
            {"refused", qint64(badScans)},
            {"recoveries", qint64(recoveries)},
            {"recovered", qint64(recovered)},
            {"by_odometry", qint64(counts.byOdometry)},
            {"odometry", odometry.state()},
            {"ms_per_scan", counts.totalMs() / scans},
            {"map_segments", qint64(mirror.size())}};
}

} // namespace hermes
