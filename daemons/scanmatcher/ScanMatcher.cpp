#include "daemons/scanmatcher/ScanMatcher.h"
#include "moc_ScanMatcher.cpp" // else it would be compiled apart, vectorlib and all

#include "common/Log.h"
#include "protocol/wire/Fields.h"

#include <utility>

namespace hermes::scanmatcher {

using vectorlib::PlaceState;

namespace {

constexpr double silent_s = 0.5;   // the first scanner: the second is matched alone
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

QString toText(SecondScanner::State state) {
    static constexpr const char *texts[] = {"on_trial", "taken", "contradicted"};
    return QString(texts[int(state)]); // in the order of the enumeration
}

} // namespace

ScanMatcher::ScanMatcher()
    : Daemon({"scanmatcher", "Scan matcher",
              "Turns laser scans into line segments, finds the sensor's pose among those of a vector map, "
              "and lets the "
              "map grow"})
    , source_("source", [this](Scan scan) { takeScan(std::move(scan)); })
    , secondSource_("source2", [this](Scan scan) {
        if (settings().flag("sensor2.upside_down"))
            scan.data.turnOver();
        takeSecond(std::move(scan));
    }) {
    files_.setMaxThreadCount(1);
    declareSettings();
    declareTopics();
    declareMatcherCommands();
    declareMapCommands();
    declareRelocalization();
    for (const Client *client : {&source_.client(), &secondSource_.client(), &odometry_.client()}) {
        connect(client, &Client::connected, this, &ScanMatcher::updateHealth);
        connect(client, &Client::subscriptionFailed, this, &ScanMatcher::updateHealth);
        connect(client, &Client::disconnected, this, &ScanMatcher::updateHealth);
    }
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
    secondSource_.close();
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
    const bool isQueue = paths.contains("source.queue");
    if (active_ && !paths.filter("source.").isEmpty())
        connectToSource(source_, "source");
    if (active_ && (isQueue || !paths.filter("source2.").isEmpty()))
        connectToSource(secondSource_, "source2");
    if (active_ && !paths.filter("odometry.").isEmpty())
        connectToOdometry();
}

void ScanMatcher::begin(bool toMap) {
    mapping_ = toMap;
    worker_->post([this, toMap, closes = closesLoops()] { map_->grow(toMap, closes); });
    active_ = true;
    connectToSource(source_, "source");
    connectToSource(secondSource_, "source2");
    connectToOdometry();
    setState(DaemonState::Running);
}

void ScanMatcher::pause() {
    active_ = false;
    skipped_ = {};
    doubt_ = {};
    source_.close();
    secondSource_.close();
    odometry_.close();
    setState(DaemonState::Ready);
}

void ScanMatcher::connectToSource(ScannerSource &source, const QString &name) {
    source.open(settings().text(name + ".address"), settings().text(name + ".topic"),
                settings().integer("source.queue"));
}

void ScanMatcher::connectToOdometry() {
    const auto opened =
        odometry_.open(settings().text("odometry.address"), settings().text("odometry.topic"));
    if (!opened)
        logError("odometry", opened.error().message);
    updateHealth();
}

// The last scan of the second scanner goes with the first one's that comes next, where the two are of about
// the same time.
void ScanMatcher::addSecond(Scan &scan) {
    std::optional<Scan> other = std::exchange(second_.waiting, std::nullopt);
    if (!other)
        return;
    if (other->replayed == scan.replayed)
        second_.apart_s = scan.data.addSecond(std::move(other->data));
    const bool isPair = scan.data.second.has_value();
    second_.apartInARow = isPair ? 0 : second_.apartInARow + 1;
    ++(isPair ? second_.paired : second_.apart);
}

// While the first scanner is silent the second is matched alone, if it was taken before. In a replay it is
// not: silence is real time, and a replay may be paused or slow.
void ScanMatcher::takeSecond(Scan scan) {
    if (scan.replayed || source_.silent_s() < silent_s || second_.state != SecondScanner::State::Taken) {
        second_.waiting = std::move(scan);
        return;
    }
    Scan alone;
    alone.number = scan.number;
    alone.replayed = scan.replayed;
    alone.data.stamp = scan.data.middle();
    second_.waiting = std::move(scan);
    match(std::move(alone));
}

void ScanMatcher::takeScan(Scan scan) {
    scan.upsideDown = settings().flag("sensor.upside_down");
    if (scan.upsideDown)
        scan.data.turnOver();
    match(std::move(scan));
}

void ScanMatcher::match(Scan scan) {
    if (std::exchange(replayed_, scan.replayed) != scan.replayed)
        worker_->post([this, replayed = scan.replayed] { map_->followReplay(replayed); });
    const double before = std::exchange(replayStamp_, scan.replayed ? scan.data.stamp : -1);
    const bool leaps =
        scan.replayed && before >= 0 && (scan.data.stamp < before || scan.data.stamp > before + longestGap_s);
    if (leaps) // it was sought
        worker_->post([this] { map_->leapInReplay(); });
    addSecond(scan);
    scan.data.odometry = odometry_.over(scan.data.firstSeen(), scan.data.lastSeen());
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
    noteSecond(o);
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
    const SourceState first = source_.state();
    state.droppedBySource = first.dropped;
    state.refused = first.refused;
    state.unknownFields = first.unknownFields;
    state.sources.push_back(first);
    if (SourceState second = secondSource_.state(); !second.address.isEmpty()) {
        second.use = toText(second_.state);
        second.paired = second_.paired;
        second.apart = second_.apart;
        second.apart_s = second_.apart_s;
        second.fitting = second_.fitting;
        state.sources.push_back(second);
    }
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

int run(int argc, char **argv) {
    return runDaemon<ScanMatcher>(argc, argv);
}

} // namespace hermes::scanmatcher
