#pragma once

#include "vectorlib/geometry/PackedPoints.h"
#include "vectorlib/graph/LoopAgreement.h"
#include "vectorlib/graph/LoopCandidates.h"
#include "vectorlib/graph/LoopGate.h"
#include "vectorlib/graph/PoseGraph.h"
#include "vectorlib/mapping/GlobalPairMatcher.h"
#include "vectorlib/mapping/TrackedBy.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
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
    double mostTurn = 0.5;
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
    double placedAlpha = 2;      ///< where the sensor was put elsewhere, as far as it was put; radians
    double odometryPart = 0.3;   ///< of the metres, where it is by odometry
    double likely = 0.3;         ///< probability with which a motion that is not accepted is a better guess
    std::size_t mostBridged = 3; ///< how many key scans back such a one is matched at most
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
    void add(PointSpan<float> points, const Transformation2D &tracked, TrackedBy by) {
        if (keys_.empty()) {
            graph_.poses.push_back(tracked.pose());
            addKey(points, tracked.pose(), 0);
            return;
        }
        const double doubt = addMotion(points, tracked, by);
        const double way = since_.way, turned = since_.turned;
        if (by > TrackedBy::Scan || way >= settings.keyWay || turned >= settings.keyTurn) {
            link(points);
            if (doubt > 0 && by != TrackedBy::Placed) // those before it lie anywhere
                bridge();
            tryLoops();
        } else {
            scans_.push_back({keys_.size() - 1, since_.motion, way + turned});
            last_.assign(points.begin(), points.end());
        }
    }
    /// Whether a loop says that the poses are wrong.
    bool hasNews() const { return news_; }
    /// Whether it is time to move them.
    bool isDue() const {
        const auto few = static_cast<std::size_t>(settings.fewPart * double(keys_.size()));
        return news_ && keys_.size() - corrected_ >= std::max(settings.fewKeys, few);
    }
    /// Moves the poses so that all motions fit best. False where none was found since the last time, or
    /// nothing fits. progress: as of PoseGraph.
    bool correct(const std::function<void(std::size_t done, std::size_t all)> &progress = {}) {
        news_ = false;
        corrected_ = keys_.size();
        if (!std::exchange(found_, false) || !graph_.optimise(progress))
            return false;
        counts_.closed = 0;
        for (const PoseConstraint &c : graph_.constraints)
            counts_.closed += c.mayBeWrong && !c.isRefused();
        candidates_.move(graph_.poses);
        findLooped();
        return true;
    }
    /// Loops found since the last correction count as closed.
    LoopCounts counts() const {
        LoopCounts counts = counts_;
        counts.refused = counts.tried - counts.closed;
        return counts;
    }
    std::size_t scans() const { return scans_.size(); }
    /// Of a scan; one between two key scans has moved with them, by its part of the way.
    Pose2D pose(std::size_t scan) const {
        const OnTheWay &s = scans_[scan];
        const Transformation2D from(graph_.poses[s.key]);
        if (s.key + 1 == keys_.size())
            return (from * s.motion).pose();
        const Key &next = keys_[s.key + 1];
        const Transformation2D off =
            from.inverse() * Transformation2D(graph_.poses[s.key + 1]) * next.motion.inverse();
        const double part = next.effort > 0 ? std::min(1.0, s.effort / next.effort) : 0;
        return (from * Transformation2D(part * off.x(), part * off.y(), part * off.alpha()) * s.motion)
            .pose();
    }
    std::vector<Pose2D> poses() const {
        std::vector<Pose2D> result(scans_.size());
        for (std::size_t i = 0; i < result.size(); ++i)
            result[i] = pose(i);
        return result;
    }
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
    void restore(Memory memory) {
        keys_ = std::move(memory.keys);
        scans_ = std::move(memory.scans);
        since_ = memory.since;
        graph_ = std::move(memory.graph);
        counts_ = memory.progress.counts;
        found_ = memory.progress.found;
        news_ = memory.progress.news;
        corrected_ = memory.progress.corrected;
        last_.clear();
        agreement.clear();
        candidates_ = LoopCandidates();
        gate_.clear();
        pointBytes_ = 0;
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            pointBytes_ += keys_[k].points.bytes();
            keys_[k].points.unpack(earlier_);
            enter(k, earlier_);
        }
        findLooped();
    }

private:
    // How much in doubt the motion is; metres.
    double addMotion(PointSpan<float> points, const Transformation2D &tracked, TrackedBy by) {
        Transformation2D motion = tracked;
        double xy = 0, alpha = 0, doubt = 0;
        if (by == TrackedBy::Placed) {
            agreement.clear();
            doubt = settings.guessedXY;
            xy = doubt + motion.translation().norm();
            alpha = settings.placedAlpha;
        } else if (by > TrackedBy::Scan) {
            const GlobalPairMatch &found = match(last_, points);
            const bool isLikely = by == TrackedBy::Nothing && !found.solutions.empty() &&
                                  found.solutions[0].probability > settings.likely;
            if (found.isAccepted() || isLikely)
                motion = found.solutions[0].pose;
            if (!found.isAccepted()) {
                const double part = by == TrackedBy::Odometry ? settings.odometryPart : 1;
                doubt = xy = part * (settings.guessedXY + settings.guessedPart * motion.translation().norm());
                alpha = settings.guessedAlpha;
            }
        }
        const double way = motion.translation().norm(), turn = std::abs(motion.alpha());
        constexpr double least = 1e-3; // metres, radians; of standing, too
        xy = std::hypot(xy, least, settings.trackedXY * std::sqrt(way));
        alpha = std::hypot(std::hypot(alpha, least), settings.trackedAlpha * std::sqrt(way),
                           settings.turnedAlpha * std::sqrt(turn));
        since_.motion = since_.motion * motion;
        since_.way += way;
        since_.turned += turn;
        since_.varianceXY += xy * xy;
        since_.varianceAlpha += alpha * alpha;
        since_.doubt += settings.drift * way + doubt;
        return doubt;
    }
    void addKey(PointSpan<float> points, const Pose2D &tracked, double doubt) {
        Key key;
        key.points = PackedPoints(points);
        pointBytes_ += key.points.bytes();
        key.scan = scans_.size();
        key.motion = since_.motion;
        key.effort = since_.way + since_.turned;
        key.varianceXY = since_.varianceXY;
        key.varianceAlpha = since_.varianceAlpha;
        key.tracked = tracked;
        key.way = (keys_.empty() ? 0 : keys_.back().way) + since_.way;
        key.doubt = doubt;
        scans_.push_back({keys_.size(), {}, 0});
        last_.assign(points.begin(), points.end());
        keys_.push_back(std::move(key));
        enter(keys_.size() - 1, points);
        since_ = SinceKey();
    }
    // The motion since the last key scan becomes part of the graph.
    void link(PointSpan<float> points) {
        const std::size_t from = keys_.size() - 1;
        const double xy = 1 / since_.varianceXY, alpha = 1 / since_.varianceAlpha;
        graph_.constraints.push_back(
            {from, from + 1, since_.motion, Eigen::Vector3d(xy, xy, alpha).asDiagonal(), false, 1});
        graph_.poses.push_back((Transformation2D(graph_.poses[from]) * since_.motion).pose());
        addKey(points, (Transformation2D(keys_[from].tracked) * since_.motion).pose(),
               keys_[from].doubt + since_.doubt);
    }
    void enter(std::size_t k, PointSpan<float> points) {
        const Key &key = keys_[k];
        if (key.varianceAlpha >= settings.placedAlpha * settings.placedAlpha)
            gate_.addPlaced(k);
        candidates_.add(
            {key.tracked, key.varianceXY, key.varianceAlpha, key.way, key.doubt, ScanSignature(points)},
            graph_.poses[k]);
    }
    // What the scan before does not show of the last one, those before may.
    void bridge() {
        const std::size_t key = keys_.size() - 1;
        for (std::size_t back = 2; back <= settings.mostBridged && back <= key; ++back)
            if (const auto loop = gate_.isAcross(key - back, key) ? std::nullopt : loopWith(key - back))
                believe(*loop);
    }
    // The nearest scans of earlier passes; where no loop was found, those near the place that the last
    // waiting one tells; and where the drive may be astray by more, the one that looks most alike.
    void tryLoops() {
        const std::size_t last = keys_.size() - 1;
        const auto waiting = agreement.newest(keys_[last].way);
        tried_.clear();
        tryNearest(graph_.poses[last], settings.perScan, 0);
        if (waiting && looped_ != last) {
            const Transformation2D there = Transformation2D(graph_.poses[waiting->loop.from]) *
                                           waiting->loop.motion * candidates_.led(waiting->loop.to, last);
            tryNearest(there.pose(), 1, waiting->loop.to);
        }
        if (looped_ == last)
            return;
        if (const auto far = candidates_.far(looped_, tried_, settings)) {
            tryLoop(far->scan, far->among);
        }
    }
    void tryNearest(const Pose2D &here, std::size_t most, std::size_t sure) {
        for (const std::size_t k : candidates_.nearest(here, most, sure, settings))
            if (std::find(tried_.begin(), tried_.end(), k) == tried_.end())
                tryLoop(k);
    }
    void tryLoop(std::size_t earlier, std::size_t among = 1) {
        tried_.push_back(earlier);
        const auto loop = loopWith(earlier);
        if (!loop)
            return;
        const PoseConstraint *known = gate_.nearestAcross(*loop, graph_, candidates_);
        const bool isOpen = !known && gate_.isAcross(loop->from, loop->to), near = isNear(*loop, known);
        if (near && !isOpen)
            return believe(*loop);
        if (isOpen && !near)
            return; // where the sensor was put is told, and not far off
        const auto tens = static_cast<std::size_t>(std::log10(double(among)));
        for (const PoseConstraint &c :
             agreement.add(*loop, end(loop->from), end(loop->to), settings.farAgreeing + tens))
            believe(c);
    }
    // `known` leads across, too, where the sensor was put elsewhere in between.
    bool isNear(const PoseConstraint &c, const PoseConstraint *known) const {
        const auto doubt = [&](std::size_t a, std::size_t b) {
            return candidates_.doubtBetween(std::min(a, b), std::max(a, b), settings);
        };
        const double most = known ? doubt(c.from, known->from) + doubt(c.to, known->to) - settings.reach
                                  : doubt(c.from, c.to);
        const Eigen::Vector3d off = graph_.errorOf(c);
        return off.head<2>().norm() < most && std::abs(off[2]) < settings.mostTurn;
    }
    LoopAgreement::End end(std::size_t key) const {
        return {Transformation2D(keys_[key].tracked), keys_[key].way};
    }
    // Of an earlier key scan with the last one, where they match and the drive allows it.
    std::optional<PoseConstraint> loopWith(std::size_t earlier) {
        ++counts_.tried;
        keys_[earlier].points.unpack(earlier_);
        const GlobalPairMatch &found = match.quickly(earlier_, last_); // other pairs will show the loop
        if (!found.isAccepted())
            return std::nullopt;
        PoseConstraint c;
        c.from = earlier;
        c.to = keys_.size() - 1;
        c.motion = found.solutions[0].pose;
        c.mayBeWrong = true;
        const double xy = settings.matchedXY, alpha = settings.matchedAlpha;
        Eigen::Matrix3d covariance = match.covarianceOf(found.solutions[0]);
        covariance.diagonal() += Eigen::Vector3d(xy * xy, xy * xy, alpha * alpha);
        c.information = covariance.inverse();
        const bool isAllowed = gate_.allows(c, covariance, graph_, candidates_, settings.gate);
        return isAllowed ? std::optional(c) : std::nullopt;
    }
    void believe(const PoseConstraint &c) {
        const Eigen::Vector3d off = graph_.errorOf(c);
        news_ = news_ || off.head<2>().norm() > settings.newsXY || std::abs(off[2]) > settings.newsAlpha;
        found_ = true;
        ++counts_.closed;
        graph_.constraints.push_back(c);
        if (isLoop(c))
            looped_ = std::max(looped_, c.to);
    }
    // Not one that only bridges a doubtful motion.
    bool isLoop(const PoseConstraint &c) const {
        return c.mayBeWrong && keys_[c.to].way - keys_[c.from].way >= settings.leastWay;
    }
    void findLooped() {
        looped_ = 0;
        for (const PoseConstraint &c : graph_.constraints)
            if (isLoop(c) && !c.isRefused())
                looped_ = std::max(looped_, c.to);
    }

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
