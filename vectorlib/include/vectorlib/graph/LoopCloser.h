#pragma once

#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/graph/DriveUncertainty.h"
#include "vectorlib/graph/PoseGraph.h"
#include "vectorlib/mapping/GlobalPairMatcher.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace vectorlib {

struct LoopCloserSettings {
    double keyWay = 1, keyTurn = 0.6; ///< between scans that are compared; metres, radians
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
    double odometryPart = 0.3;   ///< of the metres, where it is by odometry
    double likely = 0.3;         ///< probability with which a motion that is not accepted is a better guess
    std::size_t mostBridged = 3; ///< how many scans back such a one is matched at most
    /// What a match has beside its own covariance: scans are never quite of one moment and one plane.
    double matchedXY = 0.02, matchedAlpha = 0.005;
};

/// What tells how a scan lies to the one before.
enum class TrackedBy {
    Map,      ///< it was found in the map where odometry expected it
    Odometry, ///< that alone: it was lost
    Nothing   ///< a guess, or found in the map where it was guessed
};

/// How closing loops went.
struct LoopCounts {
    std::size_t tried = 0;   ///< pairs of scans compared, those that bridge a doubtful one among them
    std::size_t closed = 0;  ///< motions found that the whole drive agrees with
    std::size_t refused = 0; ///< no motion was found or accepted, or the drive contradicts it
};

/// Brings a drive that bends into one frame: scans of places that were met again are matched with each other,
/// without any estimate, and all poses move so that they fit these motions and those from scan to scan.
class LoopCloser {
public:
    LoopCloserSettings settings;
    GlobalPairMatcher match;

    /// The next scan of the drive: its points in the sensor's frame, where it was tracked, and by what.
    /// Unless that is the map it is matched with the scans before it, too.
    void add(PointSpan<float> points, const Pose2D &tracked, TrackedBy by) {
        scans_.emplace_back();
        scans_.back().points.assign(points.begin(), points.end());
        if (scans_.size() == 1) {
            graph_.poses.push_back(tracked);
            uncertainty_.add(tracked, 0, 0);
        } else {
            addMotion(Transformation2D(last_).inverse() * Transformation2D(tracked), by);
        }
        last_ = tracked;
        keep();
    }
    /// Looks for loops and moves the poses; to be called once, after the last scan. `progress` is told how
    /// many of how many scans are done.
    LoopCounts close(const std::function<void(std::size_t, std::size_t)> &progress = {}) {
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            tryLoopsOf(k);
            if (progress)
                progress(k + 1, keys_.size());
        }
        const auto isLoop = [](const PoseConstraint &c) { return c.mayBeWrong; };
        const bool isSolved =
            std::none_of(graph_.constraints.begin(), graph_.constraints.end(), isLoop) || graph_.optimise();
        for (const PoseConstraint &c : graph_.constraints)
            counts_.closed += c.mayBeWrong && isSolved && !isContradicted(c);
        counts_.refused = counts_.tried - counts_.closed;
        return counts_;
    }
    /// One a scan.
    const std::vector<Pose2D> &poses() const { return graph_.poses; }
    const PoseGraph &graph() const { return graph_; }

private:
    struct Scan {
        std::vector<Vector2D<float>> points;
        double way = 0, turned = 0; // since the start of the drive; metres, radians
        bool isKey = false;         // compared with others
        double doubt = 0;           // by how much the drive may have gone astray since its start; metres
    };
    struct Candidate {
        std::size_t scan;
        double apart; // metres, and half of the radians
    };

    void addMotion(const Transformation2D &tracked, TrackedBy by) {
        const std::size_t from = scans_.size() - 2, to = from + 1;
        Transformation2D motion = tracked;
        double xy = 0, alpha = 0, doubt = 0;
        if (by != TrackedBy::Map) {
            const GlobalPairMatch &found = match(scans_[from].points, scans_[to].points);
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
        scans_[to].way = scans_[from].way + way;
        scans_[to].turned = scans_[from].turned + turn;
        scans_[to].doubt = scans_[from].doubt + settings.drift * way + doubt;
        graph_.poses.push_back((Transformation2D(graph_.poses[from]) * motion).pose());
        uncertainty_.add(graph_.poses[to], xy * xy, alpha * alpha);
        graph_.constraints.push_back(
            {from, to, motion,
             Eigen::Vector3d(1 / (xy * xy), 1 / (xy * xy), 1 / (alpha * alpha)).asDiagonal(), false, 1});
        if (doubt > 0)
            bridge(to);
    }
    // What one scan does not show of the next, the one before it may.
    void bridge(std::size_t scan) {
        for (std::size_t back = 2; back <= settings.mostBridged && back <= scan; ++back)
            tryLoop(scan - back, scan);
    }
    // The others' points are needed for the next scans only.
    void keep() {
        const std::size_t scan = scans_.size() - 1, past = settings.mostBridged + 1;
        const Scan *last = keys_.empty() ? nullptr : &scans_[keys_.back()];
        scans_[scan].isKey = !last || scans_[scan].way - last->way >= settings.keyWay ||
                             scans_[scan].turned - last->turned >= settings.keyTurn;
        if (scans_[scan].isKey)
            keys_.push_back(scan);
        if (scan >= past && !scans_[scan - past].isKey)
            scans_[scan - past].points = {};
    }
    // The nearest scans of earlier passes, one of each pass.
    void tryLoopsOf(std::size_t number) {
        const std::size_t scan = keys_[number];
        const Pose2D &here = graph_.poses[scan];
        candidates_.clear();
        for (std::size_t k = 0; k < number; ++k) {
            const double way = scans_[scan].way - scans_[keys_[k]].way;
            if (way < settings.leastWay)
                break;
            const Pose2D &there = graph_.poses[keys_[k]];
            const double apart = std::hypot(here.x - there.x, here.y - there.y);
            const double doubt = scans_[scan].doubt - scans_[keys_[k]].doubt;
            if (apart < settings.reach + std::min(doubt, settings.mostDrift))
                candidates_.push_back(
                    {keys_[k], apart + 0.5 * std::abs(std::remainder(here.theta - there.theta, 2 * pi))});
        }
        std::sort(candidates_.begin(), candidates_.end(),
                  [](const Candidate &a, const Candidate &b) { return a.apart < b.apart; });
        passes_.clear();
        for (const Candidate &c : candidates_) {
            const double way = scans_[c.scan].way;
            const auto isSamePass = [&](double other) { return std::abs(other - way) < settings.passWay; };
            if (passes_.size() == settings.perScan || std::any_of(passes_.begin(), passes_.end(), isSamePass))
                continue;
            passes_.push_back(way);
            tryLoop(c.scan, scan);
        }
    }
    void tryLoop(std::size_t earlier, std::size_t later) {
        ++counts_.tried;
        const GlobalPairMatch &found = match(scans_[earlier].points, scans_[later].points);
        if (!found.isAccepted())
            return;
        PoseConstraint c;
        c.from = earlier;
        c.to = later;
        c.motion = found.solutions[0].pose;
        c.mayBeWrong = true;
        const double xy = settings.matchedXY, alpha = settings.matchedAlpha;
        Eigen::Matrix3d covariance = match.covarianceOf(found.solutions[0]);
        covariance.diagonal() += Eigen::Vector3d(xy * xy, xy * xy, alpha * alpha);
        c.information = covariance.inverse();
        if (isCredible(c, covariance))
            graph_.constraints.push_back(c);
    }
    // Where rooms are alike, loops that are off by the same way agree with each other: each has to agree with
    // the drive alone first.
    bool isCredible(const PoseConstraint &c, const Eigen::Matrix3d &covariance) const {
        const Pose2D &from = graph_.poses[c.from], &to = graph_.poses[c.to];
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

    std::vector<Scan> scans_;
    std::vector<std::size_t> keys_; // numbers of the scans that are compared
    PoseGraph graph_;
    DriveUncertainty uncertainty_;
    LoopCounts counts_;
    Pose2D last_; // as it was tracked
    std::vector<Candidate> candidates_;
    std::vector<double> passes_;
};

} // namespace vectorlib
