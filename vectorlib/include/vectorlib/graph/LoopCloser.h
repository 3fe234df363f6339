#pragma once

#include "vectorlib/geometry/PackedPoints.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/graph/DriveUncertainty.h"
#include "vectorlib/graph/PoseGraph.h"
#include "vectorlib/mapping/GlobalPairMatcher.h"
#include "vectorlib/mapping/TrackedBy.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace vectorlib {

struct LoopCloserSettings {
    double keyWay = 1, keyTurn = 0.6; ///< between key scans, which are compared; metres, radians
    double leastWay = 8;              ///< of the drive between two scans of a loop; metres
    double reach = 2;                 ///< scans nearer than this show the same; metres
    double drift = 0.02;     ///< metres that they may be farther apart, for each metre of way between them
    double mostDrift = 6;    ///< at most; metres
    std::size_t perScan = 2; ///< earlier passes that a scan is compared with
    double passWay = 2;      ///< of the drive between two passes; metres
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
    /// A loop is news that misses the poses by more; metres, radians. Then they are due to be moved, unless
    /// fewer key scans than this, or than this part of all, came since that was done last.
    double newsXY = 0.05, newsAlpha = 0.02;
    std::size_t fewKeys = 5;
    double fewPart = 0.02;
};

/// How closing loops went.
struct LoopCounts {
    std::size_t tried = 0;   ///< pairs of scans compared, those that bridge a doubtful one among them
    std::size_t closed = 0;  ///< motions found that the whole drive agrees with
    std::size_t refused = 0; ///< no motion was found or accepted, or the drive contradicts it
};

/// Brings a drive that bends into one frame: scans of places that were met again are matched with each other,
/// without any estimate, and all poses move so that they fit these motions and those from scan to scan. Key
/// scans are compared and are the nodes of the graph; the others keep their way between two of them.
class LoopCloser {
public:
    LoopCloserSettings settings;
    GlobalPairMatcher match;

    /// The next scan of the drive: its points in the sensor's frame, the motion since the scan before (the
    /// pose, for the first) as it was tracked, and by what. Unless that is the map the scan is matched with
    /// the one before it, too. A key scan is compared with those of earlier passes.
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
            if (doubt > 0)
                bridge();
            tryLoops();
        } else {
            scans_.push_back({keys_.size() - 1, since_.motion, way + turned});
            last_.assign(points.begin(), points.end());
        }
    }
    /// Whether a loop says that the poses are wrong, and whether it is time to move them.
    bool hasNews() const { return news_; }
    bool isDue() const {
        const auto few = static_cast<std::size_t>(settings.fewPart * double(keys_.size()));
        return news_ && keys_.size() - corrected_ >= std::max(settings.fewKeys, few);
    }
    /// Moves the poses so that all motions fit best. False where none was found since the last time, or
    /// nothing fits.
    bool correct() {
        news_ = false;
        corrected_ = keys_.size();
        if (!std::exchange(found_, false) || !graph_.optimise())
            return false;
        counts_.closed = 0;
        for (const PoseConstraint &c : graph_.constraints)
            counts_.closed += c.mayBeWrong && !isContradicted(c);
        grid_.clear();
        for (std::size_t k = 0; k < keys_.size(); ++k)
            enter(k);
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
        const double part = next.effort > 0 ? s.effort / next.effort : 0;
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

    // The parts of what it remembers; graph() is one, too.
    const std::vector<Key> &keys() const { return keys_; }
    const std::vector<OnTheWay> &onTheWay() const { return scans_; }
    const SinceKey &sinceKey() const { return since_; }
    Progress progress() const { return {counts_, found_, news_, corrected_}; }
    /// Goes on with a drive as if it had seen it itself; nothing is matched. The numbers of keys and scans
    /// must fit each other, and the graph be one that can be optimised. The next scan must not be tracked by
    /// the scan before: the points of that one are kept with key scans only.
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
        uncertainty_ = DriveUncertainty();
        grid_.clear();
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            uncertainty_.add(keys_[k].tracked, keys_[k].varianceXY, keys_[k].varianceAlpha);
            enter(k);
        }
    }

private:
    struct Candidate {
        std::size_t key;
        double apart; // metres, and half of the radians
    };

    // How much in doubt the motion is; metres.
    double addMotion(PointSpan<float> points, const Transformation2D &tracked, TrackedBy by) {
        Transformation2D motion = tracked;
        double xy = 0, alpha = 0, doubt = 0;
        if (by == TrackedBy::Placed) {
            doubt = xy = settings.guessedXY + motion.translation().norm();
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
        key.scan = scans_.size();
        key.motion = since_.motion;
        key.effort = since_.way + since_.turned;
        key.varianceXY = since_.varianceXY;
        key.varianceAlpha = since_.varianceAlpha;
        key.tracked = tracked;
        key.way = (keys_.empty() ? 0 : keys_.back().way) + since_.way;
        key.doubt = doubt;
        uncertainty_.add(tracked, since_.varianceXY, since_.varianceAlpha);
        scans_.push_back({keys_.size(), {}, 0});
        last_.assign(points.begin(), points.end());
        keys_.push_back(std::move(key));
        enter(keys_.size() - 1);
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
    void enter(std::size_t key) {
        const Vector2D<double> place(graph_.poses[key].x, graph_.poses[key].y);
        grid_.insert(static_cast<int>(key), {place, place, {1, 0}});
    }
    // What the scan before does not show of the last one, those before may.
    void bridge() {
        const std::size_t key = keys_.size() - 1;
        for (std::size_t back = 2; back <= settings.mostBridged && back <= key; ++back)
            tryLoop(key - back);
    }
    // The nearest scans of earlier passes, one of each pass.
    void tryLoops() {
        const std::size_t last = keys_.size() - 1;
        const Pose2D &here = graph_.poses[last];
        const Vector2D<double> place(here.x, here.y);
        const double most = settings.reach + settings.mostDrift;
        candidates_.clear();
        grid_.query(
            place - Vector2D<double>(most, most), place + Vector2D<double>(most, most), [&](int number) {
                const auto k = static_cast<std::size_t>(number);
                const Pose2D &there = graph_.poses[k];
                const double apart = std::hypot(here.x - there.x, here.y - there.y);
                const double doubt = std::min(keys_[last].doubt - keys_[k].doubt, settings.mostDrift);
                if (keys_[last].way - keys_[k].way >= settings.leastWay && apart < settings.reach + doubt)
                    candidates_.push_back(
                        {k, apart + 0.5 * std::abs(std::remainder(here.theta - there.theta, 2 * pi))});
            });
        std::sort(candidates_.begin(), candidates_.end(), [](const Candidate &a, const Candidate &b) {
            return std::tie(a.apart, a.key) < std::tie(b.apart, b.key);
        });
        passes_.clear();
        for (const Candidate &c : candidates_) {
            const double way = keys_[c.key].way;
            const auto isSamePass = [&](double other) { return std::abs(other - way) < settings.passWay; };
            if (std::any_of(passes_.begin(), passes_.end(), isSamePass))
                continue;
            passes_.push_back(way);
            tryLoop(c.key);
            if (passes_.size() == settings.perScan)
                break;
        }
    }
    // With the last key scan.
    void tryLoop(std::size_t earlier) {
        ++counts_.tried;
        keys_[earlier].points.unpack(earlier_);
        const GlobalPairMatch &found = match.quickly(earlier_, last_); // other pairs will show the loop
        if (!found.isAccepted())
            return;
        PoseConstraint c;
        c.from = earlier;
        c.to = keys_.size() - 1;
        c.motion = found.solutions[0].pose;
        c.mayBeWrong = true;
        const double xy = settings.matchedXY, alpha = settings.matchedAlpha;
        Eigen::Matrix3d covariance = match.covarianceOf(found.solutions[0]);
        covariance.diagonal() += Eigen::Vector3d(xy * xy, xy * xy, alpha * alpha);
        c.information = covariance.inverse();
        if (!isCredible(c, covariance))
            return;
        const Eigen::Vector3d off = graph_.errorOf(c);
        news_ = news_ || off.head<2>().norm() > settings.newsXY || std::abs(off[2]) > settings.newsAlpha;
        found_ = true;
        ++counts_.closed;
        graph_.constraints.push_back(c);
    }
    // Where rooms are alike, loops that are off by the same way agree with each other: each has to agree with
    // the drive alone first.
    bool isCredible(const PoseConstraint &c, const Eigen::Matrix3d &covariance) const {
        const Pose2D &from = keys_[c.from].tracked, &to = keys_[c.to].tracked;
        const Transformation2D led = Transformation2D(from) * c.motion;
        const Eigen::Vector3d off(led.x() - to.x, led.y() - to.y,
                                  std::remainder(led.alpha() - to.theta, 2 * pi));
        Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
        turned.topLeftCorner<2, 2>() << std::cos(from.theta), -std::sin(from.theta), std::sin(from.theta),
            std::cos(from.theta);
        const Eigen::Matrix3d spread =
            uncertainty_.between(c.from, c.to) + turned * covariance * turned.transpose();
        return off.dot(spread.ldlt().solve(off)) <= settings.gate;
    }
    static bool isContradicted(const PoseConstraint &c) {
        constexpr double least = 0.25;
        return c.weight < least;
    }

    std::vector<Key> keys_;
    std::vector<OnTheWay> scans_;
    SinceKey since_;
    std::vector<Vector2D<float>> last_;    // points of the last scan
    std::vector<Vector2D<float>> earlier_; // and of one that it is compared with
    PoseGraph graph_;                      // a pose each key scan
    DriveUncertainty uncertainty_;         // of the key scans, without any loop
    SegmentGrid grid_{4};                  // of the key scans
    LoopCounts counts_;
    bool found_ = false, news_ = false; // loops since the last correction
    std::size_t corrected_ = 0;         // key scans then
    std::vector<Candidate> candidates_;
    std::vector<double> passes_;
};

} // namespace vectorlib
