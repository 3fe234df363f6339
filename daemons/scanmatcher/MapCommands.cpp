#include "common/Log.h"
#include "daemons/scanmatcher/MapFile.h"
#include "daemons/scanmatcher/ScanMatcher.h"
#include "protocol/wire/Fields.h"

#include <QDir>

#include <utility>

namespace hermes::scanmatcher {

namespace {

constexpr double longestGap_s = 1; // between scans that follow each other
constexpr int mostFiles = 4;       // that may wait to be written, each with its copy of the map

} // namespace

void ScanMatcher::declareMapCommands() {
    const Field path = Field::text("path", "File below map.folder, relative to it");
    const Field force = Field::boolean("force", "Overwrite a file that exists").byDefault(false);
    addCommand(Command("map.get", "The whole map")
                   .needs(Role::Observer)
                   .gives<MapMessage>()
                   .handler([this](const Call &) -> Result<QJsonValue> { return asJson(mirror_.full()); }));
    addCommand(
        Command("map.save", "Writes the map as CSV, so that map.load gives the same map")
            .needs(Role::Engineer)
            .param(path)
            .param(force)
            .gives<SavedMap>()
            .asyncHandler([this](const Call &call, const Reply &reply) { saveMap("csv", call, reply); }));
    addCommand(
        Command("map.export", "Writes the map in another format")
            .needs(Role::Engineer)
            .param(Field::text("format", "Of the file").choices({"svg", "csv", "geojson", "dxf"}))
            .param(path)
            .param(force)
            .gives<SavedMap>()
            .example({{"format", "svg"}, {"path", "office.svg"}},
                     QJsonObject{{"path", "/home/robot/office.svg"}, {"segments", 48}, {"bytes", 9120}})
            .asyncHandler(
                [this](const Call &call, const Reply &reply) { saveMap(call.text("format"), call, reply); }));
    addCommand(Command("map.load",
                       "Replaces the map by one that map.save wrote, or goes on with the drive of "
                       "a journal")
                   .needs(Role::Engineer)
                   .param(path)
                   .with("x-destructive", "the map, which map.undo brings back, and the remembered drive")
                   .gives<LoadedMap>()
                   .asyncHandler([this](const Call &call, const Reply &reply) { loadMap(call, reply); }));
    addCommand(Command("map.list", "The maps and journals below map.folder, the newest first")
                   .needs(Role::Observer)
                   .gives<MapList>()
                   .asyncHandler([this](const Call &, const Reply &reply) {
                       files_.start([folder = QDir(settings().text("map.folder")).absolutePath(), reply] {
                           reply.result(asJson(listMaps(folder)));
                       });
                   }));
    addCommand(Command("map.undo",
                       "Undoes the last map.clear, map.load, pose.set, pose.relocalize or replay: its map "
                       "or pose is back, then that of the one before. What was mapped since the sensor was "
                       "put elsewhere goes, too. Where a map is back the pose is sought in it, unless it "
                       "is known; its drive is not remembered")
                   .param(Field::boolean("redo", "Carry out again what was undone last").byDefault(false))
                   .gives<BroughtBack>()
                   .asyncHandler([this](const Call &call, const Reply &reply) {
                       worker_->post([this, again = call.flag("redo"), reply](
                                         vectorlib::ScanTracker &tracker) { undo(tracker, again, reply); });
                   }));
    addCommand(Command("map.clear", "Forgets map, pose, trajectory and counts")
                   .with("x-destructive", "the map, which map.undo brings back, and the remembered drive")
                   .returnsNull()
                   .asyncHandler([this](const Call &, const Reply &reply) {
                       worker_->post([this, reply](vectorlib::ScanTracker &tracker) {
                           replace(tracker, {}, "map.clear");
                           forgetDrive();
                           showNewMap(tracker, reply, QJsonValue());
                       });
                   }));
}

MapPath ScanMatcher::mapPath(const Call &call) {
    const QDir folder(settings().text("map.folder"));
    return {folder.absoluteFilePath(call.text("path")), folder.absolutePath()};
}

// The worker gives a copy of the map as it is after the commands before this one, and goes on matching.
void ScanMatcher::saveMap(const QString &format, const Call &call, const Reply &reply) {
    if (filesUnderWay_ >= mostFiles)
        return reply.error(
            {ErrorCode::NotReady, QString("%1 files are being written already").arg(mostFiles)});
    ++filesUnderWay_;
    const auto map = std::make_shared<vectorlib::MapDrawing>();
    if (format == "svg")
        *map = {"Map of " + std::to_string(counts_.scans) + " scans", {}, mirror_.trajectory(), {}};
    const auto write = [this, map, format, file = mapPath(call), force = call.flag("force"), reply] {
        const Result<SavedMap> saved = writeMapFile(file, format, force, *map);
        if (!saved && format == "csv")
            QMetaObject::invokeMethod(this, [this] { mirror_.setSaved(false); });
        reply.give(saved ? Result<QJsonValue>(asJson(*saved)) : saved.error());
        --filesUnderWay_;
    };
    worker_->post([this, map, write, isSaved = format == "csv"](vectorlib::ScanTracker &tracker) {
        if (isSaved) // as soon as what the scans before gave is shown
            QMetaObject::invokeMethod(this, [this] { mirror_.setSaved(true); });
        tracker.builder.map.forEach([&](const vectorlib::MapEdge &edge) { map->segments.push_back(edge); });
        files_.start(write);
    });
}

// In the worker, as the scans that come after it belong into the new map.
void ScanMatcher::loadMap(const Call &call, const Reply &reply) {
    worker_->post([this, file = mapPath(call), reply](vectorlib::ScanTracker &tracker) {
        if (isDriveJournal(file))
            return loadJournal(tracker, file, reply);
        const auto loaded = readMapFile(file);
        if (!loaded)
            return reply.error(loaded.error());
        vectorlib::VectorMap map;
        for (const vectorlib::MapEdge &edge : *loaded)
            map.add(edge, edge.observations);
        replace(tracker, std::move(map), "map.load");
        forgetDrive();
        seek(tracker); // else what it maps lies anywhere in it
        showNewMap(tracker, reply, asJson(LoadedMap{loaded->size(), 0, 0, 0, 0}), true);
    });
}

void ScanMatcher::loadJournal(vectorlib::ScanTracker &tracker, const MapPath &file, const Reply &reply) {
    if (keepsLiveMap_)
        return reply.error({ErrorCode::NotReady, "a drive goes on with live scans: end the replay first"});
    auto loaded = readJournalFile(file);
    if (!loaded)
        return reply.error(loaded.error());
    auto remembered = std::make_unique<RememberedDrive>(loaded.take());
    const vectorlib::MappedDrive &drive = remembered->drive;
    if (remembered->leftOut > 0)
        logWarning("journal", QString("%1: the last %2 bytes are cut or damaged and were left out")
                                  .arg(file.path)
                                  .arg(remembered->leftOut));
    vectorlib::MapBuilder builder;
    const std::vector<vectorlib::Pose2D> poses = drive.loops.poses();
    drive.rebuild(builder, poses);
    drive.review(builder.map, poses);
    replace(tracker, std::move(builder.map), "map.load");
    tracker.place(poses.back());
    seek(tracker);
    LoadedMap answer{0, drive.loops.scans(), drive.loops.keys().size(), drive.loops.counts().closed,
                     quint64(remembered->leftOut)};
    tracker.builder.map.forEach([&](const vectorlib::MapEdge &) { ++answer.segments; });
    corrector_->resume(std::move(remembered));
    showNewMap(tracker, reply, asJson(answer));
}

// The one of now is kept, unless it is empty.
void ScanMatcher::replace(vectorlib::ScanTracker &tracker, vectorlib::VectorMap map, const char *command) {
    if (!tracker.builder.map.isEmpty())
        tellSteps(history_.add({command, std::move(tracker.builder.map), false, {}, {}}));
    tracker.clear();
    newMap_ = NewMap::No;
    tracker.builder.map = std::move(map);
    mapNumber_ = ++mapsBegun_;
}

void ScanMatcher::rememberPose(const char *command, const vectorlib::Pose2D &before,
                               vectorlib::PlaceState place) {
    const vectorlib::ScanTracker &tracker = worker_->tracker();
    tellSteps(history_.add({command, std::nullopt, true, before, tracker.motion().pose(), place}));
    keepMapOfStep(tracker);
}

void ScanMatcher::keepMapOfStep(const vectorlib::ScanTracker &tracker) {
    if (grows_ && tracker.placeState() == vectorlib::PlaceState::Known)
        history_.keepMap(tracker.builder.map);
}

void ScanMatcher::tellSteps(std::size_t mapsGone) {
    QMetaObject::invokeMethod(this, [this, mapsGone, undoes = history_.next(false),
                                     redoes = history_.next(true)] {
        undoes_ = undoes;
        redoes_ = redoes;
        if (mapsGone > 0)
            logWarning("map",
                       QString("map.undo cannot bring back %1 map(s) any more, as other commands came after")
                           .arg(mapsGone));
    });
}

void ScanMatcher::undo(vectorlib::ScanTracker &tracker, bool again, const Reply &reply) {
    std::optional<MapHistory::Step> step = history_.take(again);
    if (!step)
        return reply.error({ErrorCode::NotReady,
                            again
                                ? QString("nothing was undone since the last command")
                                : QString("there is nothing more to undo: no command of the last %1 replaced "
                                          "the map or put the sensor elsewhere")
                                      .arg(MapHistory::mostSteps)});
    const vectorlib::Pose2D now = tracker.motion().pose();
    const vectorlib::Pose2D target = step->isPose ? step->before * step->told.inverse() * now : now;
    MapHistory::Step back{step->command, std::nullopt, step->isPose, now, target, place_};
    if (step->map) {
        back.map = std::move(tracker.builder.map);
        tracker.clear();
        tracker.builder.map = std::move(*step->map);
        newMap_ = NewMap::No;
        mapNumber_ = ++mapsBegun_;
    }
    history_.put(std::move(back), again);
    tellSteps();
    const bool isSought = !step->isPose || step->place == vectorlib::PlaceState::Sought;
    if (step->place == vectorlib::PlaceState::Found)
        tracker.find(target);
    else
        tracker.claim(target);
    if (isSought && !tracker.builder.map.isEmpty())
        seek(tracker);
    place_ = tracker.placeState();
    BroughtBack answer{step->command, step->map.has_value(), !isSought, 0, target};
    tracker.builder.map.forEach([&](const vectorlib::MapEdge &) { ++answer.segments; });
    if (!step->map)
        return reply.result(asJson(answer));
    forgetDrive();
    showNewMap(tracker, reply, asJson(answer));
}

void ScanMatcher::setUp(vectorlib::ScanTracker &tracker) {
    tracker.apply(setup_.tracking);
    tracker.builder.extract.vectorize.settings.sigma = setup_.sigma;
    tracker.grow(grows_);
}

// That of the live map, which rests while a replay is mapped.
void ScanMatcher::followDrive() {
    if (!keepsLiveMap_)
        corrector_->follow(setup_.closesLoops, worker_->tracker());
}

void ScanMatcher::forgetDrive() {
    if (!keepsLiveMap_)
        corrector_->restart(worker_->tracker());
}

// What was recorded elsewhere or before is not to grow into the map of now. Where nothing is mapped it does
// not, and an empty map has nothing to keep.
void ScanMatcher::setLiveMapAside() {
    if (!grows_ || live_)
        return;
    live_.emplace();
    live_->pose = worker_->tracker().builder.report().pose;
    live_->number = mapNumber_;
    if (worker_->tracker().builder.map.isEmpty())
        return;
    keepsLiveMap_ = true;
    live_->tracker = worker_->exchange(std::make_unique<vectorlib::ScanTracker>());
    setUp(worker_->tracker());
    live_->history = std::exchange(history_, {});
    tellSteps();
    newMap_ = NewMap::No;
    mapNumber_ = ++mapsBegun_;
    QMetaObject::invokeMethod(this, [this] {
        liveView_.emplace();
        swapLiveView();
        logInfo("replay", "a replay is mapped apart; the live map and its drive are kept");
    });
    showNewMap(worker_->tracker(), std::nullopt, QJsonValue());
}

// The map of the replay can be brought back by map.undo.
void ScanMatcher::bringLiveMapBack() {
    if (!live_)
        return;
    LiveDrive live = std::move(*live_);
    live_.reset();
    if (!live.tracker) {
        replace(worker_->tracker(), {}, "replay");
        worker_->tracker().place(live.pose);
        mapNumber_ = live.number;
        forgetDrive();
        return showNewMap(worker_->tracker(), std::nullopt, QJsonValue());
    }
    const auto replayed = worker_->exchange(std::move(live.tracker));
    vectorlib::ScanTracker &tracker = worker_->tracker();
    history_ = std::move(live.history);
    tellSteps(replayed->builder.map.isEmpty() ? 0 : history_.addReplay(std::move(replayed->builder.map)));
    keepsLiveMap_ = false;
    setUp(tracker);
    mapNumber_ = live.number;
    if (tracker.odometryFrame()) { // it knows the way since then
        tracker.doubt();
        place_ = tracker.placeState();
    } else {
        tracker.place(live.pose); // it stands still
        seek(tracker);
    }
    isInterrupted_ = true;
    followDrive();
    QMetaObject::invokeMethod(this, [this, counts = tracker.counts()] { showMapAgain(counts); });
    if (live.correction)
        applyCorrection(tracker, live.correction);
}

void ScanMatcher::swapLiveView() {
    mirror_.swap(liveView_->map);
    graph_.swap(liveView_->graph);
    publishSnapshot("graph");
}

void ScanMatcher::showMapAgain(const vectorlib::ScanTrackerCounts &counts) {
    swapLiveView();
    liveView_.reset();
    publishSnapshot("map");
    countFrom(counts);
    logInfo("replay", "the live map and its drive are back; map.undo brings back the map of the replay");
}

void ScanMatcher::countFrom(const vectorlib::ScanTrackerCounts &counts) {
    counts_ = counts;
    lostInARow_ = 0;
    doubt_ = {};
    lastRecovery_.reset();
}

// One that was sought goes on elsewhere in its map, or where nobody was as yet: to expect it where the last
// scan was would map the same walls twice.
void ScanMatcher::followReplay(const Scan &scan) {
    const double before = std::exchange(replayStamp_, scan.replayed ? scan.data.stamp : -1);
    const bool isJump =
        scan.replayed && before >= 0 && (scan.data.stamp < before || scan.data.stamp > before + longestGap_s);
    if (!isJump)
        return;
    worker_->post([this](vectorlib::ScanTracker &tracker) {
        if (tracker.builder.map.isEmpty())
            return;
        tracker.place(tracker.builder.report().pose);            // it stands still
        seek(tracker, live_ ? NewMap::WhenNowhere : NewMap::No); // with live_ the map is the replay's own
    });
}

void ScanMatcher::beginReplayAnew(vectorlib::ScanTracker &tracker) {
    if (newMap_ != NewMap::Due)
        return; // another map was loaded meanwhile
    replace(tracker, {}, "replay");
    forgetDrive();
    showNewMap(tracker, std::nullopt, QJsonValue());
}

void ScanMatcher::showNewMap(vectorlib::ScanTracker &tracker, const std::optional<Reply> &reply,
                             const QJsonValue &answer, bool isSaved) {
    tracker.grow(grows_);
    place_ = tracker.placeState();
    tracker.builder.map.takeChanges(); // the mirror gets it whole
    auto edges = std::make_shared<MapMirror::Edges>();
    tracker.builder.map.forEach(
        [&](const vectorlib::MapEdge &edge) { edges->emplace_hint(edges->end(), edge.id, edge); });
    QMetaObject::invokeMethod(
        this, [this, edges = std::move(edges), number = mapNumber_, reply, answer, isSaved]() mutable {
            countFrom({});
            mirror_.replace(*edges, number);
            mirror_.setSaved(isSaved);
            if (worker_) // where the old map is freed, which takes its time too
                worker_->post([old = std::move(edges)](vectorlib::ScanTracker &) {});
            publishSnapshot("map");
            if (reply)
                reply->result(answer);
        });
}

} // namespace hermes::scanmatcher
