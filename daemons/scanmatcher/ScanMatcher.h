#pragma once

#include "common/client/Client.h"
#include "common/daemon/Daemon.h"
#include "common/daemon/PastFaults.h"
#include "daemons/scanmatcher/MapCorrector.h"
#include "daemons/scanmatcher/MapFile.h"
#include "daemons/scanmatcher/MapHistory.h"
#include "daemons/scanmatcher/MapMirror.h"
#include "daemons/scanmatcher/OdometrySource.h"
#include "daemons/scanmatcher/Worker.h"
#include "protocol/messages/Matching.h"

#include <QThreadPool>
#include <atomic>
#include <memory>

namespace hermes::scanmatcher {

/// The daemon hermes-scanmatcher: takes scans from another daemon's topic, finds the sensor's pose, builds
/// the vector map. Receives and answers in the main thread; matches in a Worker.
class ScanMatcher : public Daemon {
    Q_OBJECT
public:
    ScanMatcher();
    ~ScanMatcher() override { ScanMatcher::stop(); }

protected:
    Result<void> start() override;
    void stop() override;
    void settingsChanged(const QStringList &paths) override;

private:
    /// What the worker's thread hands over after a scan.
    struct Outcome {
        ScanResult result;
        MapChanges changes;
        vectorlib::ScanTrackerCounts counts;
        vectorlib::ScanReport::Outcome outcome = vectorlib::ScanReport::Outcome::Skipped;
        std::size_t points = 0; ///< of the scan
        std::optional<vectorlib::OdometryCheck::Ways> contradiction;
        vectorlib::ScannerCheck scanner;
        bool replayed = false;
        std::optional<vectorlib::Relocalized> recovery; ///< when the whole map was searched after this scan
    };

    /// The scans in a row that showed too little to be matched.
    struct SkippedScans {
        int count = 0;
        double since = 0;                     ///< monotonic
        std::size_t segments = 0, points = 0; ///< of the last
    };

    /// How long scans in a row have been trusted little.
    struct Doubt {
        std::optional<double> stamp; ///< of the last scan
        double trust = 0, seconds = 0;
    };

    void declareSettings();
    void declareTopics();
    void declareMatcherCommands();
    void declareMapCommands();
    void declareRelocalization();
    void updateHealth();

    void connectToSource();
    void connectToOdometry();
    void takeScan(const TopicUpdate &update);
    void begin(bool mapping);
    void pause();
    static Outcome outcomeOf(vectorlib::ScanTracker &tracker, const Scan &scan);
    void show(const Outcome &outcome);
    bool closesLoops();
    void applyCorrection(vectorlib::ScanTracker &tracker, const std::shared_ptr<Correction> &correction);
    void showCorrection(const std::shared_ptr<Correction> &correction, const MapChanges &since);
    void showGraph(GraphMessage more);
    void relocalize(bool apply, const Reply &reply);
    void showRecovery(const vectorlib::Relocalized &recovery);
    void updateTrackingHealth();
    void noteSkipped(const Outcome &outcome);
    void noteTrust(const ScanResult &result);
    bool isBlind() const;
    QString blindText() const;
    void updateSensorHealth();
    void updateMemoryHealth();
    void updateJournalHealth();
    void updateMapHealth();
    QString unsavedText() const;
    std::optional<vectorlib::Relocalized> find(vectorlib::ScanTracker &tracker);

    vectorlib::ScanTrackerSettings trackerSettings() const;
    void saveMap(const QString &format, const Call &call, const Reply &reply);
    void loadMap(const Call &call, const Reply &reply);
    void loadJournal(vectorlib::ScanTracker &tracker, const MapPath &file, const Reply &reply);
    // In the worker's thread:
    void replace(vectorlib::ScanTracker &tracker, vectorlib::VectorMap map, const char *command);
    void undo(vectorlib::ScanTracker &tracker, bool again, const Reply &reply);
    void rememberPose(const char *command, const vectorlib::Pose2D &before, vectorlib::PlaceState place);
    void keepMapOfStep(const vectorlib::ScanTracker &tracker);
    void tellSteps(std::size_t mapsGone = 0);
    void setUp(vectorlib::ScanTracker &tracker);
    void followDrive();
    void forgetDrive();
    void setLiveMapAside();
    void bringLiveMapBack();
    void followReplay(const Scan &scan);
    void beginReplayAnew(vectorlib::ScanTracker &tracker);
    /// When the map is another one: hands it over to the main thread, then answers.
    void showNewMap(vectorlib::ScanTracker &tracker, const std::optional<Reply> &reply,
                    const QJsonValue &answer, bool isSaved = false);
    void showMapAgain(const vectorlib::ScanTrackerCounts &counts);
    void countFrom(const vectorlib::ScanTrackerCounts &counts);
    void swapLiveView();
    void matchTwo(const Call &call, const Reply &reply);
    MapPath mapPath(const Call &call);
    MatcherState matcherState() const;

    std::atomic<int> filesUnderWay_{0};
    QThreadPool files_; ///< one thread, which writes maps: a disk may take its time
    std::unique_ptr<Worker> worker_;
    std::unique_ptr<MapCorrector> corrector_;
    bool corrected_ = false;  ///< since the last scan; the worker's
    MapHistory history_;      ///< the worker's
    QString undoes_, redoes_; ///< the commands that map.undo would undo, and carry out again; empty: none
    /// What live scans go on with after a replay. Its drive rests meanwhile.
    struct LiveDrive {
        std::unique_ptr<vectorlib::ScanTracker> tracker; ///< none: its map was empty
        vectorlib::Pose2D pose;
        qint64 number = 0;                      ///< of the map
        std::shared_ptr<Correction> correction; ///< not applied yet
        MapHistory history;
    };
    /// The same for the main thread.
    struct LiveView {
        MapMirror map;
        GraphMirror graph;
    };
    /// How a tracker is set up.
    struct Setup {
        vectorlib::ScanTrackerSettings tracking;
        double sigma = 0;
        bool closesLoops = false;
    };
    qint64 mapNumber_ = 0, mapsBegun_ = 0;  ///< the worker's
    bool matchesReplay_ = false;            ///< the worker's
    Setup setup_;                           ///< the worker's
    std::optional<LiveDrive> live_;         ///< while a replay is mapped; the worker's
    std::atomic<bool> keepsLiveMap_{false}; ///< it has a tracker
    std::optional<LiveView> liveView_;
    bool replayed_ = false;   ///< the last scan
    double replayStamp_ = -1; ///< of the last scan that was replayed
    /// A replay that was sought to a place that its map does not have gets a new map.
    enum class NewMap { No, WhenNowhere, Due };
    NewMap newMap_ = NewMap::No; ///< the worker's
    void seek(vectorlib::ScanTracker &tracker, NewMap newMap = NewMap::No);
    bool isInterrupted_ = false; ///< scans were not remembered since the last that was; the worker's
    std::atomic<vectorlib::PlaceState> place_{vectorlib::PlaceState::Known}; ///< set by the worker
    bool grows_ = true; ///< the map, while the place is known; the worker's
    Client source_;
    int subscription_ = 0;
    OdometrySource odometry_;
    bool active_ = false;
    bool mapping_ = true; ///< the map grows; else it stays as it is
    MapMirror mirror_;
    GraphMirror graph_;
    vectorlib::ScanTrackerCounts counts_;
    int lostInARow_ = 0;
    vectorlib::ScannerCheck scanner_;
    SkippedScans skipped_;
    Doubt doubt_;
    bool relocalizing_ = false; ///< for a command
    quint64 recoveries_ = 0,
            recovered_ = 0; ///< searches of the whole map after lost scans, and their successes
    std::optional<vectorlib::Relocalized> lastRecovery_; ///< since tracking was lost
    quint64 badScans_ = 0, droppedBySource_ = 0, unknownFields_ = 0;
    PastFaults pastBadScans_, pastDrops_, pastUnreadable_;
    double lastScan_ = 0; // monotonic; or when it began to wait for one
    QString sourceFault_; // why there will be none
    QString lastBadScan_;
};

} // namespace hermes::scanmatcher
