#pragma once

#include "vectorlib/geometry/PackedPoints.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/graph/PoseGraph.h"
#include "vectorlib/registration/PointCovariance.h"
#include "vectorlib/registration/PointRefinement.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <tuple>
#include <vector>

namespace vectorlib {

/// Settings of DriveRefiner: which scans it matches, which matches count, and how far the drive is trusted.
struct DriveRefinerSettings {
    double keyWay = 0.5, keyTurn = 0.3; ///< between key scans; metres, radians
    /// Key scans that are nearer and less turned from each other are compared; metres, radians.
    double reach = 2, mostTurn = 1;
    double leastWay = 8;     ///< of the drive between them; metres
    std::size_t perScan = 2; ///< earlier passes that a key scan is compared with
    double passWay = 2;      ///< of the drive between two passes; metres
    /// What a match needs to count; see PointAgreement.
    double minExplained = 0.6, maxContradicted = 0.1;
    double mostXY = 0.3, mostAlpha = 0.1; ///< what it may be off the poses; metres, radians
    /// Standard deviations that a match has beside its own; metres, radians.
    double matchedXY = 0.01, matchedAlpha = 0.003;
    /// With which the way from scan to scan stays as it is: of a metre, and of a radian; metres, radians.
    double keptXY = 0.04, keptAlpha = 0.014, keptTurn = 0.02;
};

/// Makes the poses of a drive whose loops are closed more exact: scans that lie near each other are matched
/// anew by their points, from where they are, and all poses move so that they fit. Each scan is matched with
/// the key scan before it, each key scan with those of earlier passes. It refines: poses that are off by more
/// than mostXY stay off.
class DriveRefiner {
public:
    DriveRefinerSettings settings;
    PointRefinement match;
    PointCovariance tellCovariance;

    /// The next scan of the drive: its points in the sensor's frame, in the order of ScanOrder, and the
    /// motion since the scan before as it was tracked (of no meaning for the first); metres, radians.
    void add(PointSpan<float> points, const Transformation2D &tracked) {
        if (!keys_.empty()) {
            since_ = since_ * tracked;
            way_ += tracked.translation().norm();
            if (const auto c = measured({keys_.back().scan, keyPoints_}, {scans_, points}, since_))
                nexts_.push_back(*c);
        }
        if (keys_.empty() || since_.translation().norm() >= settings.keyWay ||
            std::abs(since_.alpha()) >= settings.keyTurn) {
            keys_.push_back({scans_, way_, PackedPoints(points)});
            keyPoints_.assign(points.begin(), points.end());
            since_ = Transformation2D();
        }
        ++scans_;
    }
    /// Moves the poses, one for each scan that was added (metres, radians). `loops` are motions between scans
    /// that were found before, with their weights. False, and the poses are as before, where there are not as
    /// many poses as scans or the equations cannot be solved. The first pose stays. progress counts key scans
    /// that are compared with earlier ones, which takes most of the time.
    bool operator()(std::vector<Pose2D> &poses, const std::vector<PoseConstraint> &loops,
                    const std::function<void(std::size_t done, std::size_t all)> &progress = {}) {
        if (poses.size() != scans_)
            return false;
        graph_.poses = poses;
        graph_.constraints.clear();
        keepWay();
        for (const PoseConstraint &c : nexts_)
            take(c);
        for (PoseConstraint c : loops) {
            c.information *= c.weight;
            graph_.constraints.push_back(c);
        }
        comparePasses(progress);
        if (!graph_.optimise())
            return false;
        poses = graph_.poses;
        return true;
    }

private:
    struct Scan {
        std::size_t number;
        PointSpan<float> points;
    };
    struct Key {
        std::size_t scan;
        double way; // since the start of the drive; metres
        PackedPoints points;
    };
    struct Candidate {
        double apart; // metres, and half of the radians
        std::size_t key;
    };

    // Nothing where the points do not agree well.
    std::optional<PoseConstraint> measured(const Scan &from, const Scan &to,
                                           const Transformation2D &expected) {
        Expectation expectation;
        expectation.pose = expected;
        match.start(from.points, to.points);
        const Transformation2D motion = match(expected, expectation);
        const PointAgreement agreement = match.agreement(motion);
        if (!(agreement.explained() >= settings.minExplained &&
              agreement.contradicted() <= settings.maxContradicted))
            return std::nullopt;
        const double xy = settings.matchedXY, alpha = settings.matchedAlpha;
        Eigen::Matrix3d covariance = tellCovariance(match, motion);
        covariance.diagonal() += Eigen::Vector3d(xy * xy, xy * xy, alpha * alpha);
        return PoseConstraint{from.number, to.number, motion, covariance.inverse(), true, 1};
    }
    void take(const PoseConstraint &c) {
        const Eigen::Vector3d off = graph_.errorOf(c);
        if (off.head<2>().norm() <= settings.mostXY && std::abs(off[2]) <= settings.mostAlpha)
            graph_.constraints.push_back(c);
    }
    Transformation2D motionBetween(std::size_t from, std::size_t to) const {
        return Transformation2D(graph_.poses[from]).inverse() * Transformation2D(graph_.poses[to]);
    }
    void keepWay() {
        constexpr double least = 1e-3; // metres, radians; of standing, too
        for (std::size_t to = 1; to < scans_; ++to) {
            const Transformation2D motion = motionBetween(to - 1, to);
            const double way = motion.translation().norm(), turn = std::abs(motion.alpha());
            const double xy = std::hypot(least, settings.keptXY * std::sqrt(way));
            const double alpha =
                std::hypot(least, settings.keptAlpha * std::sqrt(way), settings.keptTurn * std::sqrt(turn));
            graph_.constraints.push_back(
                {to - 1, to, motion,
                 Eigen::Vector3d(1 / (xy * xy), 1 / (xy * xy), 1 / (alpha * alpha)).asDiagonal(), false, 1});
        }
    }
    void comparePasses(const std::function<void(std::size_t, std::size_t)> &progress) {
        SegmentGrid grid(settings.reach);
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            const Pose2D &here = graph_.poses[keys_[k].scan];
            const Vector2D<double> place(here.x, here.y);
            compareWithNearest(k, grid);
            grid.insert(static_cast<int>(k), {place, place, {1, 0}});
            if (progress)
                progress(k + 1, keys_.size());
        }
    }
    // The nearest key scans of earlier passes, one of each pass.
    void compareWithNearest(std::size_t key, SegmentGrid &grid) {
        findCandidates(key, grid);
        passes_.clear();
        keys_[key].points.unpack(keyPoints_);
        for (const Candidate &c : candidates_) {
            const Key &earlier = keys_[c.key], &later = keys_[key];
            const auto isSamePass = [&](double way) {
                return std::abs(way - earlier.way) < settings.passWay;
            };
            if (std::any_of(passes_.begin(), passes_.end(), isSamePass))
                continue;
            passes_.push_back(earlier.way);
            earlier.points.unpack(earlier_);
            if (const auto found = measured({earlier.scan, earlier_}, {later.scan, keyPoints_},
                                            motionBetween(earlier.scan, later.scan)))
                take(*found);
            if (passes_.size() == settings.perScan)
                break;
        }
    }
    void findCandidates(std::size_t key, SegmentGrid &grid) {
        const Pose2D &here = graph_.poses[keys_[key].scan];
        const Vector2D<double> place(here.x, here.y), reach(settings.reach, settings.reach);
        candidates_.clear();
        grid.query(place - reach, place + reach, [&](int number) {
            const auto k = static_cast<std::size_t>(number);
            const Pose2D &there = graph_.poses[keys_[k].scan];
            const double apart = std::hypot(here.x - there.x, here.y - there.y);
            const double turn = std::abs(std::remainder(here.theta - there.theta, 2 * pi));
            if (apart < settings.reach && turn < settings.mostTurn &&
                keys_[key].way - keys_[k].way >= settings.leastWay)
                candidates_.push_back({apart + 0.5 * turn, k});
        });
        std::sort(candidates_.begin(), candidates_.end(), [](const Candidate &a, const Candidate &b) {
            return std::tie(a.apart, a.key) < std::tie(b.apart, b.key);
        });
    }

    std::size_t scans_ = 0;
    double way_ = 0;         // since the start of the drive; metres
    Transformation2D since_; // motion since the last key scan
    std::vector<Key> keys_;
    std::vector<Vector2D<float>> keyPoints_, earlier_; // of the key scan at hand, and of one before it
    std::vector<PoseConstraint> nexts_;                // from each scan's key scan to it
    PoseGraph graph_;                                  // a pose each scan
    std::vector<Candidate> candidates_;
    std::vector<double> passes_;
};

} // namespace vectorlib
