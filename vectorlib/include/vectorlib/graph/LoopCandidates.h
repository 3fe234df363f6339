#pragma once

#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/graph/DriveUncertainty.h"
#include "vectorlib/graph/ScanSignature.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

namespace vectorlib {

/// Which scans of a drive may show one place.
struct LoopCandidateSettings {
    double leastWay = 8;  ///< of the drive between two scans of a loop; metres
    double reach = 2;     ///< scans nearer than this show the same; metres
    double mostDrift = 6; ///< that the nearest scans may be farther apart, as the drive is in doubt; metres
    double passWay = 2;   ///< of the drive between two passes; metres
    /// Where the drive may have gone astray farther than that, a scan is looked for among all within so many
    /// standard deviations.
    double farDeviations = 3;
};

/// The scans of a drive that may show the same place as its last one.
class LoopCandidates {
public:
    /// A scan of the drive; metres and radians, variances in their squares.
    struct Scan {
        Pose2D tracked;                           ///< without any loop
        double varianceXY = 0, varianceAlpha = 0; ///< of the motion from the scan before
        double way = 0;                           ///< since the start of the drive; metres
        double doubt = 0; ///< by how much the drive may have gone astray since its start; metres
        ScanSignature signature;
    };

    /// The next scan, and where it is thought to be.
    void add(const Scan &scan, const Pose2D &pose) {
        uncertainty_.add(scan.tracked, scan.varianceXY, scan.varianceAlpha);
        scans_.push_back(scan);
        poses_.push_back(pose);
        enter(scans_.size() - 1);
    }
    /// All scans are thought to be elsewhere.
    void move(const std::vector<Pose2D> &poses) {
        poses_ = poses;
        grid_.clear();
        for (std::size_t k = 0; k < scans_.size(); ++k)
            enter(k);
    }
    /// Memory that they take, about, but for what is in reserve.
    std::size_t bytes() const {
        return scans_.size() * (sizeof(Scan) + sizeof(Pose2D)) + uncertainty_.bytes();
    }
    const Scan &scan(std::size_t k) const { return scans_[k]; }
    /// The motion between two scans as the drive alone led.
    Transformation2D led(std::size_t from, std::size_t to) const {
        return Transformation2D(scans_[from].tracked).inverse() * Transformation2D(scans_[to].tracked);
    }
    /// Of the poses, without any loop.
    const DriveUncertainty &uncertainty() const { return uncertainty_; }
    /// By how much the drive may be astray between two scans, where the nearest scans are asked for; metres.
    double doubtBetween(std::size_t from, std::size_t to, const LoopCandidateSettings &settings) const {
        return settings.reach + std::min(scans_[to].doubt - scans_[from].doubt, settings.mostDrift);
    }
    /// Where the last scan is near `here`: the nearest scans of earlier passes, one of each, so many at most.
    /// The drive is in doubt since each of them, or no more than since scan `sure`. Valid until the next
    /// call.
    const std::vector<std::size_t> &nearest(const Pose2D &here, std::size_t most, std::size_t sure,
                                            const LoopCandidateSettings &settings) {
        const std::size_t last = scans_.size() - 1;
        const Vector2D<double> place(here.x, here.y);
        const double farthest = settings.reach + settings.mostDrift;
        near_.clear();
        grid_.query(
            place - Vector2D<double>(farthest, farthest), place + Vector2D<double>(farthest, farthest),
            [&](int number) {
                const auto k = static_cast<std::size_t>(number);
                const Pose2D &there = poses_[k];
                const double apart = std::hypot(here.x - there.x, here.y - there.y);
                if (wayTo(k) >= settings.leastWay && apart < doubtBetween(std::max(k, sure), last, settings))
                    near_.push_back(
                        {k, apart + 0.5 * std::abs(std::remainder(here.theta - there.theta, 2 * pi))});
            });
        std::sort(near_.begin(), near_.end(), [](const Near &a, const Near &b) {
            return std::tie(a.apart, a.scan) < std::tie(b.apart, b.scan);
        });
        chosen_.clear();
        for (const Near &n : near_) {
            const auto isSamePass = [&](std::size_t other) {
                return std::abs(scans_[other].way - scans_[n.scan].way) < settings.passWay;
            };
            if (chosen_.size() < most && std::none_of(chosen_.begin(), chosen_.end(), isSamePass))
                chosen_.push_back(n.scan);
        }
        return chosen_;
    }

    /// A scan that was found far from where the last one is thought to be.
    struct Far {
        std::size_t scan; ///< the one that looks most alike
        std::size_t among;
    };
    /// Of all places where the last scan may be, as the drive went on without a loop since scan `sure`; but
    /// for the scans `except`. Nothing where the nearest ones are enough.
    std::optional<Far> far(std::size_t sure, const std::vector<std::size_t> &except,
                           const LoopCandidateSettings &settings) const {
        const std::size_t last = scans_.size() - 1;
        const Eigen::Matrix2d widest = spreadSince(sure);
        const double farthest =
            settings.farDeviations *
            std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(widest).eigenvalues()[1]);
        if (!(farthest > settings.reach + settings.mostDrift))
            return std::nullopt;
        const Eigen::Matrix2d reach = Eigen::Matrix2d::Identity() * settings.reach * settings.reach;
        const Eigen::Matrix2d sureInformation = (widest + reach).inverse();
        const double most = settings.farDeviations * settings.farDeviations;
        Far found{last, 0};
        float least = 0;
        for (std::size_t k = 0; k < last && wayTo(k) >= settings.leastWay; ++k) {
            const Eigen::Vector2d off(poses_[k].x - poses_[last].x, poses_[k].y - poses_[last].y);
            if (!(off.dot(sureInformation * off) <= most))
                continue;
            if (k > sure && !(off.dot((spreadSince(k) + reach).inverse() * off) <= most))
                continue;
            ++found.among;
            const float unlike = scans_[k].signature.distance(scans_[last].signature);
            if ((found.scan == last || unlike < least) &&
                std::find(except.begin(), except.end(), k) == except.end()) {
                least = unlike;
                found.scan = k;
            }
        }
        return found.scan == last ? std::nullopt : std::optional(found);
    }

private:
    struct Near {
        std::size_t scan;
        double apart; // metres, and half of the radians
    };

    void enter(std::size_t k) {
        const Vector2D<double> place(poses_[k].x, poses_[k].y);
        grid_.insert(static_cast<int>(k), {place, place, {1, 0}});
    }
    // Of the drive up to the last scan.
    double wayTo(std::size_t k) const { return scans_.back().way - scans_[k].way; }
    // Of the last scan's place, where scan `from` is certain, in the frame of the poses.
    Eigen::Matrix2d spreadSince(std::size_t from) const {
        const std::size_t last = scans_.size() - 1;
        const Eigen::Matrix2d turn =
            Eigen::Rotation2Dd(poses_[last].theta - scans_[last].tracked.theta).toRotationMatrix();
        return turn * uncertainty_.between(from, last).topLeftCorner<2, 2>() * turn.transpose();
    }

    std::vector<Scan> scans_;
    std::vector<Pose2D> poses_;
    DriveUncertainty uncertainty_;
    SegmentGrid grid_{4};
    std::vector<Near> near_;
    std::vector<std::size_t> chosen_;
};

} // namespace vectorlib
