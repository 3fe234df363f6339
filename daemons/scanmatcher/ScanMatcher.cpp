#include "daemons/scanmatcher/ScanMatcher.h"
#include "moc_ScanMatcher.cpp" // else it would be compiled apart, vectorlib and all

#include "common/Log.h"
#include "common/Time.h"
#include "protocol/wire/Fields.h"

#include <Eigen/LU>

namespace hermes {

using vectorlib::ScanReport;
using vectorlib::ScanTracker;

namespace {

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
    result.pose = {report.pose, tracker.motion().twist(), covariance(match), toText(report.outcome),
                   scan.number};
    result.match = {scan.number,
                    match.accepted,
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
    addTopic(Topic("pose", "Where the sensor is after each scan, in the map's frame").carries<PoseMessage>());
    addTopic(
        Topic("segments", "Line segments of the last scan in the map's frame: x1, y1, x2, y2 of each (m)")
            .carries<SegmentsMessage>());
    addTopic(Topic("map", "Changes of the map. Begins with the full map. A step of more than 1 in revision "
                          "means that changes were missed: subscribe again or call map.get")
                 .carries<MapMessage>()
                 .snapshotParts([this](qint64 &cursor) { return mirror.part(cursor); }));
    addTopic(Topic("match", "How the last scan was matched").carries<MatchMessage>());
    addTopic(Topic("scan", "What pose, match and segments say of a scan, together").carries<ScanResult>());
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
    auto parsed = readScan(update.data, unknownFields);
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
    Outcome o;
    o.result = resultOf(tracker, scan);
    o.outcome = tracker.builder.report().outcome;
    o.counts = tracker.counts();
    o.changes = takeChanges(tracker.builder.map);
    return o;
}

void ScanMatcher::show(const Outcome &o) {
    counts = o.counts;
    lostInARow = o.outcome == ScanReport::Outcome::Lost ? lostInARow + 1 : 0;
    if (lostInARow == 0)
        lastRecovery.reset();
    const ScanResult &r = o.result;
    mirror.addPose({r.stamp, {r.pose.pose.x, r.pose.pose.y, r.pose.pose.theta}});
    publish("scan", r, r.stamp);
    publish("pose", r.pose, r.stamp);
    publish("match", r.match, r.stamp);
    publish("segments", r.segments, r.stamp);
    if (!o.changes.changed.empty() || !o.changes.removed.empty())
        publish("map", mirror.apply(o.changes), r.stamp);
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
        health().set("source", pastBadScans.level(double(badScans)),
                     QString("refused %1 scans, the last: %2").arg(badScans).arg(lastBadScan));
    else
        health().set("source", HealthLevel::Ok, "connected to " + address);
    odometry.report(health());
    const quint64 dropped = droppedBySource + (worker ? worker->dropped() : 0);
    health().set("queue", pastDrops.level(double(dropped)),
                 dropped ? QString("%1 scans were dropped").arg(dropped) : QString("no scan dropped"),
                 asJson(matcherState()).toObject());
    updateTrackingHealth();
}

MatcherState ScanMatcher::matcherState() const {
    MatcherState state;
    state.active = active;
    state.mode = mapping ? "mapping" : "localization";
    state.scans = quint64(counts.scans);
    state.matched = quint64(counts.matched);
    state.lost = quint64(counts.lost);
    state.skipped = quint64(counts.skipped);
    state.waiting = worker ? worker->waiting() : 0;
    state.dropped = worker ? worker->dropped() : 0;
    state.droppedBySource = droppedBySource;
    state.refused = badScans;
    state.unknownFields = unknownFields;
    state.recoveries = recoveries;
    state.recovered = recovered;
    state.byOdometry = quint64(counts.byOdometry);
    state.odometry = odometry.state();
    state.msPerScan = counts.totalMs() / std::max<double>(1, double(counts.scans));
    state.mapSegments = mirror.size();
    return state;
}

} // namespace hermes
