#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/PackedPoints.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/graph/LoopCandidates.h"
#include "vectorlib/graph/PoseGraph.h"
#include "vectorlib/mapping/GlobalPairMatcher.h"
#include "vectorlib/mapping/TimedScan.h"

#include <Eigen/LU>
#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

namespace vectorlib {

/// Settings of LoopCloser: which scans it compares, how far it trusts the drive, and when the poses are due
/// to be moved.
struct LoopCloserSettings : LoopCandidateSettings {
    double keyWay = 1, keyTurn = 0.6; ///< between key scans, which are compared; metres, radians
    double drift = 0.02;              ///< metres that the drive may go astray, for each metre of its way
    std::size_t perScan = 2;          ///< earlier passes that a scan is compared with, as the nearest ones
    /// A loop that turns the scan by more (radians), or moves it farther than the nearest scans are looked
    /// for, waits until others agree with it.
    double maxTurn = 0.5;
    /// So many loops must agree then, and one more for each tenfold number of scans among which it was found.
    std::size_t farAgreeing = 4;
    /// Standard deviations of a metre that was tracked, and of a radian; metres, radians. Variances grow with
    /// the way, however many scans were made on it.
    double trackedXY = 0.02, trackedAlpha = 0.007, turnedAlpha = 0.01;
    /// Squared standard deviations by which a loop may miss where the drive alone led: of three degrees of
    /// freedom one in two thousand misses by more.
    double gate = 18;
    /// Of one that was guessed and not found by matching; metres, radians, and of its length.
    double guessedXY = 1, guessedAlpha = 0.3, guessedPart = 0.5;
    double placedAlpha = 2;     ///< where the sensor was put elsewhere, as far as it was put; radians
    double odometryPart = 0.3;  ///< of the metres, where it is by odometry
    double likely = 0.3;        ///< probability with which a motion that is not accepted is a better guess
    std::size_t maxBridged = 3; ///< how many key scans back such a one is matched at most
    /// What a match has beside its own covariance: scans are never quite of one moment and one plane.
    double matchedXY = 0.02, matchedAlpha = 0.005;
    /// A loop is news that misses the poses by more; metres, radians. Then they are due to be moved.
    double newsXY = 0.05, newsAlpha = 0.02;
    std::size_t fewKeys = 5; ///< but not before so many key scans came since that was done last
    double fewPart = 0.02;   ///< the same as a part of all key scans
};

/// How closing loops went.
struct LoopCounts {
    std::size_t tried = 0;   ///< pairs of scans compared, those that bridge a doubtful one among them
    std::size_t closed = 0;  ///< motions found that the whole drive agrees with
    std::size_t refused = 0; ///< no motion was found or accepted, the drive contradicts it, or it waits
};

/// Brings a drive that bends into one frame: scans of places that were met again are matched with each other,
/// without any estimate, and all poses move so that they fit these motions and those from scan to scan. Key
/// scans are compared and are the nodes of the graph; the others keep their way between two of them.
class LoopCloser {
public:
    LoopCloserSettings settings;
    GlobalPairMatcher match;
    LoopAgreement agreement; ///< of loops that move a scan far, or lead across where the sensor was put

    /// The next scan of the drive: its points in the sensor's frame, the motion since the scan before (the
    /// pose, for the first) as it was tracked, and by what. Unless that is the map or the
    /// scan before, it is matched with that scan, too. A key scan is compared with those of earlier passes.
    void add(PointSpan<float> points, const Transformation2D &tracked, TrackedBy by);
    /// Whether a loop says that the poses are wrong.
    bool hasNews() const { return news_; }
    /// Whether it is time to move them.
    bool isDue() const;
    /// Moves the poses so that all motions fit best. False where none was found since the last time, or
    /// nothing fits. progress: as of PoseGraph.
    bool correct(const std::function<void(std::size_t done, std::size_t all)> &progress = {});
    /// Loops found since the last correction count as closed.
    LoopCounts counts() const {
        LoopCounts counts = counts_;
        counts.refused = counts.tried - counts.closed;
        return counts;
    }
    std::size_t scans() const { return scans_.size(); }
    /// Of a scan; one between two key scans has moved with them, by its part of the way.
    Pose2D pose(std::size_t scan) const;
    std::vector<Pose2D> poses() const;
    /// Of the key scans.
    const PoseGraph &graph() const { return graph_; }
    /// Memory that it takes, about, but for what is in reserve.
    std::size_t bytes() const {
        return pointBytes_ + keys_.size() * (sizeof(Key) + sizeof(Pose2D)) +
               scans_.size() * sizeof(OnTheWay) + graph_.constraints.size() * sizeof(PoseConstraint) +
               candidates_.bytes();
    }
    /// The scan that a pose of the graph is of.
    std::size_t scanOf(std::size_t key) const { return keys_[key].scan; }

    /// A key scan, as it is remembered.
    struct Key {
        PackedPoints points;
        std::size_t scan = 0;
        Transformation2D motion;                  ///< since the key before
        double effort = 0;                        ///< of that motion; metres and radians
        double varianceXY = 0, varianceAlpha = 0; ///< of that motion
        Pose2D tracked;                           ///< without any loop
        double way = 0;                           ///< since the start of the drive; metres
        double doubt = 0; ///< by how much the drive may have gone astray since its start; metres
    };
    /// Any scan: a key scan has no motion.
    struct OnTheWay {
        std::size_t key;
        Transformation2D motion; ///< since that key
        double effort;           ///< metres and radians
    };
    /// Of the scans after the last key scan.
    struct SinceKey {
        Transformation2D motion;
        double way = 0, turned = 0;               ///< metres, radians
        double varianceXY = 0, varianceAlpha = 0; ///< of the motion
        double doubt = 0;                         ///< metres
    };
    /// What LoopCloser found so far.
    struct Progress {
        LoopCounts counts;
        bool found = false, news = false; ///< loops since the last correction
        std::size_t corrected = 0;        ///< key scans then
    };
    /// What is remembered of a drive: all that a closer needs to go on with it.
    struct Memory {
        std::vector<Key> keys;
        std::vector<OnTheWay> scans;
        SinceKey since;
        PoseGraph graph; ///< a pose each key scan
        Progress progress;
    };

    /// The parts of Memory; graph() is one, too.
    const std::vector<Key> &keys() const { return keys_; }
    /// All scans.
    const std::vector<OnTheWay> &onTheWay() const { return scans_; }
    /// The motion since the last key scan.
    const SinceKey &sinceKey() const { return since_; }
    Progress progress() const { return {counts_, found_, news_, corrected_}; }
    /// Goes on with a drive as if it had seen it itself; nothing is matched. The numbers of keys and scans
    /// must fit each other, and the graph be one that can be optimised. The next scan must be tracked by
    /// Placed, Map or Scan: the points of the one before it are kept with key scans only.
    void restore(Memory memory);

private:
    // How much in doubt the motion is; metres.
    double addMotion(PointSpan<float> points, const Transformation2D &tracked, TrackedBy by);
    void addKey(PointSpan<float> points, const Pose2D &tracked, double doubt);
    // The motion since the last key scan becomes part of the graph.
    void link(PointSpan<float> points);
    void enter(std::size_t k, PointSpan<float> points);
    // What the scan before does not show of the last one, those before may.
    void bridge();
    // The nearest scans of earlier passes; where no loop was found, those near the place that the last
    // waiting one tells; and where the drive may be astray by more, the one that looks most alike.
    void tryLoops();
    void tryNearest(const Pose2D &here, std::size_t most, std::size_t sure) {
        for (const std::size_t k : candidates_.nearest(here, most, sure, settings))
            if (std::find(tried_.begin(), tried_.end(), k) == tried_.end())
                tryLoop(k);
    }
    void tryLoop(std::size_t earlier, std::size_t among = 1);
    // `known` leads across, too, where the sensor was put elsewhere in between.
    bool isNear(const PoseConstraint &c, const PoseConstraint *known) const;
    LoopAgreement::End end(std::size_t key) const {
        return {Transformation2D(keys_[key].tracked), keys_[key].way};
    }
    // Of an earlier key scan with the last one, where they match and the drive allows it.
    std::optional<PoseConstraint> loopWith(std::size_t earlier);
    void believe(const PoseConstraint &c);
    // Not one that only bridges a doubtful motion.
    bool isLoop(const PoseConstraint &c) const {
        return c.mayBeWrong && keys_[c.to].way - keys_[c.from].way >= settings.leastWay;
    }
    void findLooped();

    std::vector<Key> keys_;
    std::size_t pointBytes_ = 0; // of the keys
    std::vector<OnTheWay> scans_;
    SinceKey since_;
    std::vector<Vector2D<float>> last_;    // points of the last scan
    std::vector<Vector2D<float>> earlier_; // and of one that it is compared with
    PoseGraph graph_;                      // a pose each key scan
    LoopCandidates candidates_;            // the key scans
    LoopGate gate_;
    std::size_t looped_ = 0;         // the last key scan that has a loop
    std::vector<std::size_t> tried_; // key scans, with the last one
    LoopCounts counts_;
    bool found_ = false, news_ = false; // loops since the last correction
    std::size_t corrected_ = 0;         // key scans then
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/LoopCloser.cpp")
