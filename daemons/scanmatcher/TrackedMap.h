#pragma once

#include "daemons/scanmatcher/MapCorrector.h"
#include "daemons/scanmatcher/MapFile.h"
#include "daemons/scanmatcher/MapHistory.h"
#include "daemons/scanmatcher/MatcherMessages.h"
#include "daemons/scanmatcher/ScanOutcome.h"

#include <QObject>
#include <atomic>
#include <memory>
#include <optional>

namespace hermes::scanmatcher {

/// A viewer shows the map that scans are matched with, in another thread.
class MapViewer {
public:
    using Edges = std::shared_ptr<MapMirror::Edges>;

    virtual ~MapViewer() = default;

    virtual void showScan(const ScanOutcome &outcome) = 0;
    /// The map is another one, of that number.
    virtual void showMap(Edges edges, qint64 number, bool isSaved) = 0;
    virtual void showCorrection(const std::shared_ptr<Correction> &correction, const MapChanges &since) = 0;
    /// The commands that map.undo would undo, and carry out again; empty: none.
    virtual void showSteps(const QString &undoes, const QString &redoes) = 0;
    /// A replay is mapped from now on, apart from the live map.
    virtual void setLiveMapAside() = 0;
    virtual void showLiveMapAgain(const vectorlib::ScanTrackerCounts &counts) = 0;
};

/// The map that scans are matched with, the pose in it, what map.undo brings back, and the live map while a
/// replay is matched. All of it belongs to the thread of the worker, but where it says so.
class TrackedMap {
public:
    /// How a tracker is set up.
    struct Setup {
        vectorlib::ScanTrackerSettings tracking;
        double sigma = 0;
        bool closesLoops = false;
    };

    /// The viewer's functions are called in the thread of the context, while that lives.
    TrackedMap(QObject &context, MapViewer &viewer, MapCorrector &corrector)
        : context_(context)
        , viewer_(viewer)
        , corrector_(corrector) {}

    // In any thread.
    vectorlib::PlaceState place() const { return place_; }
    /// A replay is mapped, and the live map is kept with its drive.
    bool keepsLiveMap() const { return keepsLiveMap_; }

    void set(const Setup &setup);
    /// Whether scans let the map grow from now on.
    void grow(bool grows, bool closesLoops);
    void take(Scan &scan);
    /// The scans from now on are those of a replay, or live ones.
    void followReplay(bool replayed);
    /// The next scan of the replay does not follow from the last.
    void leapInReplay();
    void correct(const std::shared_ptr<Correction> &correction);

    void setPose(const Pose2D &pose, bool isSure);
    vectorlib::Relocalized relocalize(bool apply);
    void clear();
    Result<LoadedMap> load(const MapPath &file);
    Result<BroughtBack> undo(bool again);
    const vectorlib::VectorMap &map() const { return tracker_->builder.map; }

private:
    /// What live scans go on with after a replay. Its drive rests meanwhile.
    struct LiveDrive {
        std::unique_ptr<vectorlib::ScanTracker> tracker; ///< none: its map was empty
        vectorlib::Pose2D pose;
        qint64 number = 0;                      ///< of the map
        std::shared_ptr<Correction> correction; ///< not applied yet
        MapHistory history;
    };
    /// A replay that was sought to a place that its map does not have gets a new map.
    enum class NewMap { No, WhenNowhere, Due };

    template <typename Show>
    void tell(Show show) {
        QMetaObject::invokeMethod(&context_,
                                  [&viewer = viewer_, show = std::move(show)]() mutable { show(viewer); });
    }
    std::optional<vectorlib::Relocalized> find();
    void seek(NewMap newMap = NewMap::No);
    void setUp();
    void replace(vectorlib::VectorMap map, const char *command);
    void beginMap(vectorlib::VectorMap map);
    Result<LoadedMap> loadJournal(const MapPath &file);
    void rememberPose(const char *command, const vectorlib::Pose2D &before, vectorlib::PlaceState place);
    void keepMapOfStep();
    void tellSteps(std::size_t mapsGone = 0);
    void tellMap(bool isSaved = false);
    void followDrive();
    void forgetDrive();
    void setLiveMapAside();
    void bringLiveMapBack();
    void beginReplayAnew();

    QObject &context_;
    MapViewer &viewer_;
    MapCorrector &corrector_;
    std::unique_ptr<vectorlib::ScanTracker> tracker_ = std::make_unique<vectorlib::ScanTracker>();
    Setup setup_;
    bool grows_ = true; ///< the map, while the place is known
    std::atomic<vectorlib::PlaceState> place_{vectorlib::PlaceState::Known};
    MapHistory history_;
    qint64 number_ = 0, begun_ = 0; ///< of this map; of maps
    bool isCorrected_ = false;      ///< since the last scan
    bool isInterrupted_ = false;    ///< scans were not remembered since the last that was
    bool matchesReplay_ = false;
    NewMap newMap_ = NewMap::No;
    std::optional<LiveDrive> live_;         ///< while a replay is mapped
    std::atomic<bool> keepsLiveMap_{false}; ///< it has a tracker
};

} // namespace hermes::scanmatcher
