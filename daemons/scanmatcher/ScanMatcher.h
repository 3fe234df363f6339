#pragma once

#include "common/daemon/Daemon.h"
#include "common/daemon/PastFaults.h"
#include "daemons/scanmatcher/MapMirror.h"
#include "daemons/scanmatcher/OdometrySource.h"
#include "daemons/scanmatcher/ScannerSource.h"
#include "daemons/scanmatcher/TrackedMap.h"
#include "daemons/scanmatcher/Worker.h"
#include "protocol/messages/Matching.h"

#include <QThreadPool>
#include <atomic>
#include <memory>

namespace hermes::scanmatcher {

using vectorlib::SecondScanner;

/// The daemon hermes-scanmatcher: takes scans from another daemon's topic, finds the sensor's pose, builds
/// the vector map. Receives and answers in the main thread; the TrackedMap belongs to the
/// thread of the Worker.
class ScanMatcher : public Daemon, private MapViewer {
    Q_OBJECT
public:
    ScanMatcher();
    ~ScanMatcher() override { ScanMatcher::stop(); }

protected:
    Result<void> start() override;
    void stop() override;
    void settingsChanged(const QStringList &paths) override;

private:
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

    void connectToSource(ScannerSource &source, const QString &name);
    void connectToOdometry();
    void takeScan(Scan scan);
    void takeSecond(Scan scan);
    void match(Scan scan);
    void addSecond(Scan &scan);
    void begin(bool mapping);
    void pause();
    bool closesLoops();
    void showGraph(GraphMessage more);
    void relocalize(bool apply, const Reply &reply);
    void showRecovery(const vectorlib::Relocalized &recovery);
    void updateTrackingHealth();
    void noteSkipped(const ScanOutcome &outcome);
    void noteSecond(const ScanOutcome &outcome);
    void noteTrust(const ScanResult &result);
    bool isBlind() const;
    QString blindText() const;
    void updateSensorHealth();
    void updateSecondHealth();
    QString secondText() const;
    void updateMemoryHealth();
    void updateJournalHealth();
    void updateMapHealth();
    QString unsavedText() const;

    void showScan(const ScanOutcome &outcome) override;
    void showMap(Edges edges, qint64 number, bool isSaved) override;
    void showCorrection(const std::shared_ptr<Correction> &correction, const MapChanges &since) override;
    void showSteps(const QString &undoes, const QString &redoes) override;
    void setLiveMapAside() override;
    void showLiveMapAgain(const vectorlib::ScanTrackerCounts &counts) override;

    vectorlib::ScanTrackerSettings trackerSettings() const;
    void saveMap(const QString &format, const Call &call, const Reply &reply);
    void countFrom(const vectorlib::ScanTrackerCounts &counts);
    void swapLiveView();
    void matchTwo(const Call &call, const Reply &reply);
    MapPath mapPath(const Call &call);
    MatcherState matcherState() const;
    vectorlib::PlaceState place() const { return map_ ? map_->place() : vectorlib::PlaceState::Known; }

    std::atomic<int> filesUnderWay_{0};
    QThreadPool files_; ///< one thread, which writes maps: a disk may take its time
    std::unique_ptr<MapCorrector> corrector_;
    std::unique_ptr<TrackedMap> map_; ///< the worker's
    std::unique_ptr<Worker> worker_;
    QString undoes_, redoes_; ///< the commands that map.undo would undo, and carry out again; empty: none
    /// What is shown of the live map again after a replay.
    struct LiveView {
        MapMirror map;
        GraphMirror graph;
    };
    std::optional<LiveView> liveView_;
    bool replayed_ = false;   ///< the last scan
    double replayStamp_ = -1; ///< of the last scan that was replayed
    ScannerSource source_, secondSource_;
    /// The second scanner, beside the first.
    struct Second {
        std::optional<Scan> waiting; ///< the last, for the first one's next scan
        quint64 paired = 0, apart = 0;
        int apartInARow = 0;
        double apart_s = 0; ///< the last two
        SecondScanner::State state = SecondScanner::State::OnTrial;
        std::optional<Pose2D> fitting;
    };
    Second second_;
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
    PastFaults pastDrops_;
};

/// main() of the daemon.
int run(int argc, char **argv);

} // namespace hermes::scanmatcher
