#pragma once

#include "daemons/scanmatcher/DriveJournal.h"
#include "protocol/messages/VectorMap.h"
#include "vectorlib/graph/MappedDrive.h"
#include "vectorlib/mapping/ScanTracker.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace hermes::scanmatcher {

/// A map that was made anew, as the drive came back to a place.
struct Correction {
    quint64 drive = 0;                          ///< the drive it is of
    quint64 scans = 0;                          ///< of that drive, that it has
    vectorlib::VectorMap map;                   ///< for the matching; the old one once it is applied
    std::map<qint64, vectorlib::MapEdge> edges; ///< the same, for the main thread
    std::vector<quint64> numbers;               ///< of the scans, since the map was begun
    std::vector<vectorlib::Pose2D> poses;       ///< of these scans
    vectorlib::Pose2D last;                     ///< of the last of them
    double farthest = 0;                        ///< that a pose was moved; metres
    GraphMessage graph;
};

/// How closing loops goes.
struct CorrectorState {
    vectorlib::LoopCounts loops;
    quint64 keys = 0, corrections = 0, waiting = 0, dropped = 0;
    bool isDue = false;        ///< loops say that the poses are wrong, or a correction is under way
    bool isUnderWay = false;   ///< the map is being made anew
    std::size_t bytes = 0;     ///< of memory that the drive takes
    bool isFull = false;       ///< these are all it may: what is driven now is not remembered
    double longestStallMs = 0; ///< that the matching waited for a correction
    JournalState journal;
};

/// A thread that remembers the drive, closes its loops and makes the map anew while the matching goes on.
/// Scans wait in a bounded queue; one that finds it full leaves its motion to the next and is counted.
class MapCorrector {
public:
    /// Both are called in its thread. After a correction was told it rests until acknowledge() is called.
    using Corrected = std::function<void(std::shared_ptr<Correction>)>;
    using Grown = std::function<void(const GraphMessage &)>;

    /// The drive is written down in a journal of that name below the folder; without a name it is not.
    MapCorrector(Corrected corrected, Grown grown, QString folder, QString journal)
        : corrected_(std::move(corrected))
        , grown_(std::move(grown))
        , journal_(std::move(folder), std::move(journal))
        , thread_([this] { run(); }) {}
    ~MapCorrector() { stop(); }
    /// Ends the thread; nothing is told from then on.
    void stop();

    /// Memory that a drive may take. What is driven beyond that is not remembered, so that the map is not
    /// made anew any more, until another drive begins.
    void setLimit(std::size_t bytes) { limit_ = bytes; }

    // In the matching's thread.

    /// Whether the scans that come are part of a drive. A drive begins in the tracker's map.
    void follow(bool follows, const vectorlib::ScanTracker &tracker);
    /// The map is another one: what was remembered belongs to the old one.
    void restart(const vectorlib::ScanTracker &tracker);
    /// The map is that of a drive that was remembered, which goes on with the next scan, wherever that is.
    void resume(std::unique_ptr<RememberedDrive> remembered);
    /// The scan that the tracker took last; interrupted: it does not follow from the one before.
    void add(const vectorlib::ScanTracker &tracker, const std::vector<vectorlib::Vector2D<float>> &points,
             bool isInterrupted = false);
    /// The tracker gets the map and goes on where it lies in it. False: it is of another drive, and nothing
    /// happened.
    bool apply(vectorlib::ScanTracker &tracker, Correction &correction);
    /// After a correction was told, whether it was applied or not, and shown: the thread may go on.
    void acknowledge();

    // In any thread.

    /// Frees what may take its time.
    void dispose(std::shared_ptr<Correction> old) {
        Item item;
        item.old = std::move(old);
        push(std::move(item));
    }
    CorrectorState state() const;

private:
    struct Seen {
        quint64 number = 0; // of the scan, since the map was begun
        std::vector<vectorlib::Vector2D<float>> points;
        std::vector<vectorlib::EdgeRaw2D> edges;
        std::uint32_t own = 0;              // edges that the first scanner saw
        vectorlib::Transformation2D motion; // since the scan before; the pose of the first
        vectorlib::TrackedBy by = vectorlib::TrackedBy::Map;
        double trust = 0;
    };
    struct Item {
        quint64 drive = 0;
        std::shared_ptr<const Seen> scan;            // of that drive; else the drive begins,
        std::vector<vectorlib::MapEdge> known;       // in this map;
        std::shared_ptr<RememberedDrive> remembered; // or goes on with this one;
        std::shared_ptr<Correction> old;             // or this is to be freed
    };
    struct Pending {
        std::shared_ptr<const Seen> scan;
        vectorlib::Transformation2D pose;
    };

    static bool isStill(const Seen &seen);
    void beginDrive(quint64 scans);
    void forget(std::vector<vectorlib::MapEdge> known);
    // Those below this number of the drive: the other thread has them.
    void forgetPending(quint64 end) {
        for (; !pending_.empty() && added_ - pending_.size() < end; pending_.pop_front())
            lastTaken_ = pending_.front().pose;
    }
    bool isEnding() const {
        const std::lock_guard lock(mutex_);
        return ending_;
    }
    void push(Item item);
    void run();
    bool wait();
    void take();
    void take(const Item &item);
    void remember(const Item &item);
    void tellMemory();
    void tellUnderWay(bool isUnderWay);
    // Once the last correction is applied.
    void tellFull() {
        const std::lock_guard lock(mutex_);
        state_.isFull = drive_ == remembered_;
    }
    void correct();
    void tellGrown();
    GraphMessage graph(std::size_t first, std::size_t constraint) const;
    void handOver(std::shared_ptr<Correction> correction);

    const Corrected corrected_;
    const Grown grown_;
    std::atomic<std::size_t> limit_{std::numeric_limits<std::size_t>::max()}; // bytes

    // Of the matching's thread:
    bool follows_ = false;
    quint64 added_ = 0;                               // scans of it
    bool isResumed_ = false;                          // no scan came since
    std::optional<vectorlib::Transformation2D> pose_; // of the last scan
    vectorlib::Transformation2D lastTaken_;           // of the last scan that the other thread has
    std::optional<Seen> leftOut_; // motions that have no scan: it stood, or the queue was full
    std::deque<Pending> pending_; // the last scans, which a correction may lack

    // Of its own thread:
    vectorlib::MappedDrive memory_;
    vectorlib::MapBuilder builder_;
    quint64 remembered_ = 0; // the drive that is remembered
    DriveJournal journal_;
    bool isFull_ = false;          // and takes no further scan
    std::size_t resumed_ = 0;      // scans that were remembered before
    std::vector<quint64> numbers_; // of those since
    std::vector<double> trust_;
    std::size_t toldKeys_ = 0, toldConstraints_ = 0;

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<Item> items_;
    CorrectorState state_;
    quint64 drive_ = 0;         // the one under way; only the matching's thread begins one
    quint64 taken_ = 0;         // its scans that this thread has
    bool isHandedOver_ = false; // a correction that is not applied yet
    bool ending_ = false;
    std::thread thread_;
};

} // namespace hermes::scanmatcher
