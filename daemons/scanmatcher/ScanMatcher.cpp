#include "daemons/scanmatcher/ScanMatcher.h"
#include "moc_ScanMatcher.cpp" // else it would be compiled apart, vectorlib and all

#include "common/Log.h"
#include "common/Time.h"
#include "protocol/wire/Fields.h"

#include <utility>

namespace hermes::scanmatcher {

using vectorlib::PlaceState;

namespace {

constexpr double longestGap_s = 1; // between scans of a replay that follow each other

QString toText(PlaceState place) {
    switch (place) {
    case PlaceState::Found:
        return "found";
    case PlaceState::Told:
        return "told";
    case PlaceState::Sought:
        return "sought";
    case PlaceState::Known:
        break;
    }
    return "known";
}

} // namespace

ScanMatcher::ScanMatcher()
    : Daemon({"scanmatcher", "Scan matcher",
              "Turns laser scans into line segments, finds the sensor's pose among those of a vector map, "
              "and lets the "
              "map grow"}) {
    files_.setMaxThreadCount(1);
    declareSettings();
    declareTopics();
    declareMatcherCommands();
    declareMapCommands();
    declareRelocalization();
    connect(&source_, &Client::connected, this, [this] {
        lastScan_ = monotonicNow();
        sourceFault_.clear();
        updateHealth();
    });
    connect(&source_, &Client::subscriptionFailed, this, [this](int, const RpcError &error) {
        sourceFault_ = error.message;
        logError("source", sourceFault_);
        updateHealth();
    });
    connect(&source_, &Client::disconnected, this, &ScanMatcher::updateHealth);
    connect(&odometry_.client(), &Client::connected, this, &ScanMatcher::updateHealth);
    connect(&odometry_.client(), &Client::disconnected, this, &ScanMatcher::updateHealth);
}

void ScanMatcher::declareTopics() {
    addTopic(Topic("pose", "Where the sensor is after each scan, in the map's frame").carries<PoseMessage>());
    addTopic(
        Topic("segments", "Line segments of the last scan in the map's frame: x1, y1, x2, y2 of each (m)")
            .carries<SegmentsMessage>());
    addTopic(Topic("map", "Changes of the map. Begins with the full map, and again (cleared) when it is made "
                          "anew. Else a step of more than 1 in revision means that changes were missed: "
                          "subscribe again or call map.get")
                 .carries<MapMessage>()
                 .snapshotParts([this](qint64 &cursor) { return mirror_.part(cursor); }));
    addTopic(Topic("graph", "How the drive was composed: new key scans and the loops found with them. Begins "
                            "with the whole graph, which comes again when the map was corrected")
                 .carries<GraphMessage>()
                 .snapshotParts([this](qint64 &cursor) { return graph_.part(cursor); }));
    addTopic(Topic("match", "How the last scan was matched").carries<MatchMessage>());
    addTopic(Topic("scan", "What pose, match and segments say of a scan, together").carries<ScanResult>());
}

Result<void> ScanMatcher::start() {
    const auto correct = [this](const std::shared_ptr<Correction> &correction) {
        worker_->post([this, correction] { map_->correct(correction); });
    };
    const auto grow = [this](const GraphMessage &more) {
        QMetaObject::invokeMethod(this, [this, more] { showGraph(more); });
    };
    corrector_ = std::make_unique<MapCorrector>(correct, grow, settings().text("map.folder"),
                                                settings().text("map.journal"));
    MapViewer &viewer = *this;
    map_ = std::make_unique<TrackedMap>(*this, viewer, *corrector_);
    worker_ = std::make_unique<Worker>([this](Scan &scan) { map_->take(scan); });
    settingsChanged({});
    health().provide("tracking", [this] { updateHealth(); });
    setState(DaemonState::Ready);
    const QString wanted = settings().text("matcher.start");
    if (wanted != "nothing")
        begin(wanted == "mapping");
    return {};
}

void ScanMatcher::stop() {
    if (!worker_)
        return;
    source_.close();
    odometry_.close();
    corrector_->stop();
    worker_->stop(); // its last jobs still need it
    worker_.reset();
    files_.waitForDone();
    if (const QString lost = unsavedText(); !lost.isEmpty())
        logWarning("map", "not saved when this program ended: " + lost);
}

void ScanMatcher::settingsChanged(const QStringList &paths) {
    if (!worker_)
        return;
    corrector_->setLimit(std::size_t(1e6 * settings().number("matcher.remember_mb")));
    worker_->setQueueLimit(size_t(settings().integer("source.queue")));
    const TrackedMap::Setup setup{trackerSettings(), settings().number("matcher.sigma_m"), closesLoops()};
    worker_->post([this, setup] { map_->set(setup); });
    if (active_ && !paths.filter("source.").isEmpty())
        connectToSource();
    if (active_ && !paths.filter("odometry.").isEmpty())
        connectToOdometry();
}

void ScanMatcher::begin(bool toMap) {
    mapping_ = toMap;
    worker_->post([this, toMap, closes = closesLoops()] { map_->grow(toMap, closes); });
    active_ = true;
    connectToSource();
    connectToOdometry();
    setState(DaemonState::Running);
}

void ScanMatcher::pause() {
    active_ = false;
    skipped_ = {};
    doubt_ = {};
    source_.close();
    odometry_.close();
    setState(DaemonState::Ready);
}

void ScanMatcher::connectToSource() {
    source_.close();
    source_.unsubscribe(subscription_);
    sourceFault_.clear();
    source_.prefer("cbor");
    const auto connecting = source_.connectTo(settings().text("source.address"));
    if (!connecting) {
        sourceFault_ = connecting.error().message;
        logError("source", sourceFault_);
        return;
    }
    subscription_ =
        source_.subscribe(settings().text("source.topic"), {{"queue", settings().integer("source.queue")}},
                          [this](const TopicUpdate &update) { takeScan(update); });
}

void ScanMatcher::connectToOdometry() {
    const auto opened =
        odometry_.open(settings().text("odometry.address"), settings().text("odometry.topic"));
    if (!opened)
        logError("odometry", opened.error().message);
    updateHealth();
}

void ScanMatcher::takeScan(const TopicUpdate &update) {
    lastScan_ = monotonicNow();
    sourceFault_.clear();
    droppedBySource_ = update.dropped;
    auto parsed = readScan(update.data, unknownFields_);
    if (!parsed) {
        const bool isFirst = pastBadScans_.level(double(badScans_)) == HealthLevel::Ok; // for a minute
        ++badScans_;
        if (isFirst)
            logWarning("source", parsed.error().message);
        lastBadScan_ = parsed.error().message;
        return;
    }
    Scan scan = parsed.take();
    scan.replayed |= update.replayed;
    if (scan.partial)
        return;
    if (std::exchange(replayed_, scan.replayed) != scan.replayed)
        worker_->post([this, replayed = scan.replayed] { map_->followReplay(replayed); });
    const double before = std::exchange(replayStamp_, scan.replayed ? scan.data.stamp : -1);
    const bool leaps =
        scan.replayed && before >= 0 && (scan.data.stamp < before || scan.data.stamp > before + longestGap_s);
    if (leaps) // it was sought
        worker_->post([this] { map_->leapInReplay(); });
    scan.data.odometry = odometry_.over(scan.data.begin(), scan.data.end());
    worker_->push(std::move(scan));
}

void ScanMatcher::showScan(const ScanOutcome &o) {
    if (o.contradiction && o.counts.contradicted > counts_.contradicted)
        odometry_.contradict(*o.contradiction, !o.replayed && settings().flag("odometry.stop"));
    counts_ = o.counts;
    scanner_ = o.scanner;
    lostInARow_ = o.outcome == vectorlib::ScanReport::Outcome::Lost ? lostInARow_ + 1 : 0;
    if (lostInARow_ == 0)
        lastRecovery_.reset();
    noteSkipped(o);
    const ScanResult &r = o.result;
    noteTrust(r);
    mirror_.addPose({r.stamp, {r.pose.pose.x, r.pose.pose.y, r.pose.pose.theta}});
    publish("scan", r, r.stamp);
    publish("pose", r.pose, r.stamp);
    publish("match", r.match, r.stamp);
    publish("segments", r.segments, r.stamp);
    if (!o.changes.changed.empty() || !o.changes.removed.empty())
        publish("map", mirror_.apply(o.changes), r.stamp);
    if (o.recovery)
        showRecovery(*o.recovery);
}

bool ScanMatcher::closesLoops() {
    return mapping_ && settings().flag("matcher.close_loops");
}

void ScanMatcher::showCorrection(const std::shared_ptr<Correction> &correction, const MapChanges &since) {
    logInfo(
        "loops",
        QString("the map was made anew; the drive moved by up to %1 m").arg(correction->farthest, 0, 'f', 2));
    mirror_.correct(correction->edges, correction->numbers, correction->poses);
    mirror_.apply(since);
    graph_.replace(std::move(correction->graph));
    publishSnapshot("map");
    publishSnapshot("graph");
    corrector_->dispose(std::make_shared<Correction>(std::move(*correction)));
}

void ScanMatcher::showMap(Edges edges, qint64 number, bool isSaved) {
    countFrom({});
    mirror_.replace(*edges, number);
    mirror_.setSaved(isSaved);
    if (worker_) // where the old map is freed, which takes its time too
        worker_->post([old = std::move(edges)] {});
    publishSnapshot("map");
}

void ScanMatcher::showSteps(const QString &undoes, const QString &redoes) {
    undoes_ = undoes;
    redoes_ = redoes;
}

void ScanMatcher::setLiveMapAside() {
    liveView_.emplace();
    swapLiveView();
    logInfo("replay", "a replay is mapped apart; the live map and its drive are kept");
}

void ScanMatcher::showLiveMapAgain(const vectorlib::ScanTrackerCounts &counts) {
    swapLiveView();
    liveView_.reset();
    publishSnapshot("map");
    countFrom(counts);
    logInfo("replay", "the live map and its drive are back; map.undo brings back the map of the replay");
}

void ScanMatcher::swapLiveView() {
    mirror_.swap(liveView_->map);
    graph_.swap(liveView_->graph);
    publishSnapshot("graph");
}

void ScanMatcher::countFrom(const vectorlib::ScanTrackerCounts &counts) {
    counts_ = counts;
    lostInARow_ = 0;
    doubt_ = {};
    lastRecovery_.reset();
}

void ScanMatcher::showGraph(GraphMessage more) {
    if (liveView_) // it is of the live drive
        return more.cleared ? liveView_->graph.replace(std::move(more))
                            : void(liveView_->graph.grow(std::move(more)));
    if (!more.cleared)
        return publish("graph", graph_.grow(std::move(more)));
    graph_.replace(std::move(more));
    publishSnapshot("graph");
}

MatcherState ScanMatcher::matcherState() const {
    MatcherState state;
    state.active = active_;
    state.mode = mapping_ ? "mapping" : "localization";
    state.place = toText(place());
    state.undoes = undoes_;
    state.redoes = redoes_;
    state.scans = quint64(counts_.scans);
    state.matched = quint64(counts_.matched);
    state.lost = quint64(counts_.lost);
    state.skipped = quint64(counts_.skipped);
    state.doubted = quint64(counts_.doubted);
    state.restarts = quint64(counts_.restarts);
    state.waiting = worker_ ? worker_->waiting() : 0;
    state.dropped = worker_ ? worker_->dropped() : 0;
    state.droppedBySource = droppedBySource_;
    state.refused = badScans_;
    state.unknownFields = unknownFields_;
    state.recoveries = recoveries_;
    state.recovered = recovered_;
    state.byOdometry = quint64(counts_.byOdometry);
    state.odometry = odometry_.state();
    state.msPerScan = counts_.totalMs() / std::max<double>(1, double(counts_.scans));
    state.mapSegments = mirror_.size();
    const CorrectorState loops = corrector_ ? corrector_->state() : CorrectorState();
    state.keyScans = loops.keys;
    state.closures = loops.loops.closed;
    state.closuresTried = loops.loops.tried;
    state.corrections = loops.corrections;
    state.loopsWaiting = loops.waiting;
    state.loopsDropped = loops.dropped;
    state.correction = loops.isUnderWay ? "running" : loops.isDue ? "due" : "none";
    state.rememberedMb = 1e-6 * double(loops.bytes);
    state.memoryFull = loops.isFull;
    state.longestStallMs = loops.longestStallMs;
    return state;
}

} // namespace hermes::scanmatcher
