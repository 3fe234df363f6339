#include "daemons/scanmatcher/TrackedMap.h"

#include "common/Log.h"

#include <utility>

namespace hermes::scanmatcher {

using vectorlib::PlaceState;
using vectorlib::Relocalized;
using vectorlib::ScanTracker;

void TrackedMap::set(const Setup &setup) {
    setup_ = setup;
    setUp();
    followDrive();
}

void TrackedMap::setUp() {
    tracker_->apply(setup_.tracking);
    tracker_->builder.extract.vectorize.settings.sigma = setup_.sigma;
    tracker_->grow(grows_);
}

void TrackedMap::grow(bool grows, bool closesLoops) {
    if (grows && tracker_->isContradicted()) // else it would be mapped at a wrong place
        seek();
    grows_ = grows;
    setup_.closesLoops = closesLoops;
    if (matchesReplay_)
        setLiveMapAside();
    tracker_->grow(grows_);
    keepMapOfStep();
    followDrive();
}

void TrackedMap::take(Scan &scan) {
    tracker_->process(scan.data);
    const std::optional<Relocalized> recovery = find();
    if (place_ != PlaceState::Known)
        isInterrupted_ = true;
    else if (!keepsLiveMap_) // else the drive is that of the live map
        corrector_.add(*tracker_, scan.data.points, std::exchange(isInterrupted_, false));
    keepMapOfStep();
    ScanOutcome outcome = outcomeOf(*tracker_, scan);
    outcome.result.pose.corrected = std::exchange(isCorrected_, false);
    outcome.recovery = recovery;
    tell([outcome](MapViewer &viewer) { viewer.showScan(outcome); });
    if (newMap_ == NewMap::Due)
        beginReplayAnew();
}

// Searches the whole map when it is time to. What waits for a place goes on when it is found.
std::optional<Relocalized> TrackedMap::find() {
    const bool confirms = tracker_->wantsToConfirm();
    const std::optional<Relocalized> found = tracker_->recover();
    place_ = tracker_->placeState();
    if (confirms && found) {
        logInfo("tracking", QString("a second search %1 the place: %2")
                                .arg(place_ == PlaceState::Known ? "confirms" : "does not confirm")
                                .arg(QString::fromStdString(found->text())));
        return std::nullopt;
    }
    if (found && !found->isFound() && newMap_ == NewMap::WhenNowhere)
        newMap_ = NewMap::Due; // not now: what the scan gave is to be told
    return found;
}

// Until it is found or told, scans count as lost.
void TrackedMap::seek(NewMap newMap) {
    newMap_ = newMap;
    tracker_->seek();
    place_ = tracker_->placeState();
}

// While a replay is mapped it waits, and the corrector rests, until the live map is back.
void TrackedMap::correct(const std::shared_ptr<Correction> &correction) {
    if (keepsLiveMap_) {
        live_->correction = correction;
        return;
    }
    const vectorlib::Transformation2D before(tracker_->motion().pose());
    if (corrector_.apply(*tracker_, *correction)) {
        history_.move(vectorlib::Transformation2D(tracker_->motion().pose()) * before.inverse());
        isCorrected_ = true;
        tell([correction, since = takeChanges(tracker_->builder.map)](MapViewer &viewer) {
            viewer.showCorrection(correction, since);
        });
    } else {
        corrector_.dispose(correction);
    }
    corrector_.acknowledge(); // what it tells from now on comes behind the correction
}

void TrackedMap::setPose(const Pose2D &pose, bool isSure) {
    const Pose2D before = tracker_->motion().pose();
    const PlaceState placeBefore = place_;
    isSure ? tracker_->place(pose, 1) : tracker_->claim(pose);
    place_ = tracker_->placeState();
    rememberPose("pose.set", before, placeBefore);
}

Relocalized TrackedMap::relocalize(bool apply) {
    const Pose2D before = tracker_->motion().pose();
    const PlaceState placeBefore = place_;
    const Relocalized found = tracker_->relocalize(apply);
    place_ = tracker_->placeState();
    if (apply && found.isFound())
        rememberPose("pose.relocalize", before, placeBefore);
    return found;
}

void TrackedMap::clear() {
    replace({}, "map.clear");
    forgetDrive();
    tellMap();
}

Result<LoadedMap> TrackedMap::load(const MapPath &file) {
    if (isDriveJournal(file))
        return loadJournal(file);
    const auto loaded = readMapFile(file);
    if (!loaded)
        return loaded.error();
    vectorlib::VectorMap map;
    for (const vectorlib::MapEdge &edge : *loaded)
        map.add(edge, edge.observations);
    replace(std::move(map), "map.load");
    forgetDrive();
    seek(); // else what it maps lies anywhere in it
    tellMap(true);
    return LoadedMap{loaded->size(), 0, 0, 0, 0};
}

Result<LoadedMap> TrackedMap::loadJournal(const MapPath &file) {
    if (keepsLiveMap_)
        return Error{ErrorCode::NotReady, "a drive goes on with live scans: end the replay first"};
    auto loaded = readJournalFile(file);
    if (!loaded)
        return loaded.error();
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
    replace(std::move(builder.map), "map.load");
    tracker_->place(poses.back());
    seek();
    const LoadedMap answer{map().size(), drive.loops.scans(), drive.loops.keys().size(),
                           drive.loops.counts().closed, quint64(remembered->leftOut)};
    corrector_.resume(std::move(remembered));
    tellMap();
    return answer;
}

// The one of now is kept, unless it is empty.
void TrackedMap::replace(vectorlib::VectorMap map, const char *command) {
    if (!tracker_->builder.map.isEmpty())
        tellSteps(history_.add({command, std::move(tracker_->builder.map), false, {}, {}}));
    beginMap(std::move(map));
}

void TrackedMap::beginMap(vectorlib::VectorMap map) {
    tracker_->clear();
    newMap_ = NewMap::No;
    tracker_->builder.map = std::move(map);
    number_ = ++begun_;
}

void TrackedMap::rememberPose(const char *command, const vectorlib::Pose2D &before, PlaceState place) {
    tellSteps(history_.add({command, std::nullopt, true, before, tracker_->motion().pose(), place}));
    keepMapOfStep();
}

void TrackedMap::keepMapOfStep() {
    if (grows_ && tracker_->placeState() == PlaceState::Known)
        history_.keepMap(tracker_->builder.map);
}

void TrackedMap::tellSteps(std::size_t mapsGone) {
    tell([undoes = history_.next(false), redoes = history_.next(true)](MapViewer &viewer) {
        viewer.showSteps(undoes, redoes);
    });
    if (mapsGone > 0)
        logWarning("map",
                   QString("map.undo cannot bring back %1 map(s) any more, as other commands came after")
                       .arg(mapsGone));
}

Result<BroughtBack> TrackedMap::undo(bool again) {
    std::optional<MapHistory::Step> step = history_.take(again);
    if (!step)
        return Error{ErrorCode::NotReady,
                     again ? QString("nothing was undone since the last command")
                           : QString("there is nothing more to undo: no command of the last %1 replaced the "
                                     "map or put the sensor elsewhere")
                                 .arg(MapHistory::maxSteps)};
    const vectorlib::Pose2D now = tracker_->motion().pose();
    const vectorlib::Pose2D target = step->isPose ? step->before * step->told.inverse() * now : now;
    MapHistory::Step back{step->command, std::nullopt, step->isPose, now, target, place_};
    if (step->map) {
        back.map = std::move(tracker_->builder.map);
        beginMap(std::move(*step->map));
    }
    history_.put(std::move(back), again);
    tellSteps();
    const bool isSought = !step->isPose || step->place == PlaceState::Sought;
    if (step->place == PlaceState::Found) {
        tracker_->seek(); // a break of before does not tell that it is nearby
        tracker_->placeFound(target);
    } else {
        tracker_->claim(target);
    }
    if (isSought && !tracker_->builder.map.isEmpty())
        seek();
    place_ = tracker_->placeState();
    if (step->map) {
        forgetDrive();
        tellMap();
    }
    return BroughtBack{step->command, step->map.has_value(), !isSought, map().size(), target};
}

void TrackedMap::tellMap(bool isSaved) {
    tracker_->grow(grows_);
    place_ = tracker_->placeState();
    tracker_->builder.map.takeChanges(); // the viewer gets it whole
    auto edges = std::make_shared<MapMirror::Edges>();
    map().forEach([&](const vectorlib::MapEdge &edge) { edges->emplace_hint(edges->end(), edge.id, edge); });
    tell([edges = std::move(edges), number = number_, isSaved](MapViewer &viewer) mutable {
        viewer.showMap(std::move(edges), number, isSaved);
    });
}

// That of the live map, which rests while a replay is mapped.
void TrackedMap::followDrive() {
    if (!keepsLiveMap_)
        corrector_.follow(setup_.closesLoops, *tracker_);
}

void TrackedMap::forgetDrive() {
    if (!keepsLiveMap_)
        corrector_.restart(*tracker_);
}

void TrackedMap::followReplay(bool replayed) {
    matchesReplay_ = replayed;
    replayed ? setLiveMapAside() : bringLiveMapBack();
}

// What was recorded elsewhere or before is not to grow into the map of now. Where nothing is mapped it does
// not, and an empty map has nothing to keep.
void TrackedMap::setLiveMapAside() {
    if (!grows_ || live_)
        return;
    live_.emplace();
    live_->pose = tracker_->builder.report().pose;
    live_->number = number_;
    if (map().isEmpty())
        return;
    keepsLiveMap_ = true;
    live_->tracker = std::exchange(tracker_, std::make_unique<ScanTracker>());
    setUp();
    live_->history = std::exchange(history_, {});
    tellSteps();
    newMap_ = NewMap::No;
    number_ = ++begun_;
    tell([](MapViewer &viewer) { viewer.setLiveMapAside(); });
    tellMap();
}

// The map of the replay can be brought back by map.undo.
void TrackedMap::bringLiveMapBack() {
    if (!live_)
        return;
    LiveDrive live = std::move(*live_);
    live_.reset();
    if (!live.tracker) {
        replace({}, "replay");
        tracker_->place(live.pose);
        number_ = live.number;
        forgetDrive();
        return tellMap();
    }
    const auto replayed = std::exchange(tracker_, std::move(live.tracker));
    history_ = std::move(live.history);
    tellSteps(replayed->builder.map.isEmpty() ? 0 : history_.addReplay(std::move(replayed->builder.map)));
    keepsLiveMap_ = false;
    setUp();
    number_ = live.number;
    if (tracker_->odometryFrame()) { // it knows the way since then
        tracker_->doubt();
        place_ = tracker_->placeState();
    } else {
        tracker_->place(live.pose); // it stands still
        seek();
    }
    isInterrupted_ = true;
    followDrive();
    tell([counts = tracker_->counts()](MapViewer &viewer) { viewer.showLiveMapAgain(counts); });
    if (live.correction)
        correct(live.correction);
}

// It goes on elsewhere in its map, or where nobody was as yet: to expect it where the last scan was would map
// the same walls twice.
void TrackedMap::leapInReplay() {
    if (map().isEmpty())
        return;
    tracker_->place(tracker_->builder.report().pose); // it stands still
    seek(live_ ? NewMap::WhenNowhere : NewMap::No);   // with live_ the map is the replay's own
}

void TrackedMap::beginReplayAnew() {
    replace({}, "replay");
    forgetDrive();
    tellMap();
}

} // namespace hermes::scanmatcher
