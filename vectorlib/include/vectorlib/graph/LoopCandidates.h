#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/graph/PoseGraph.h"

#include <Eigen/Core>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace vectorlib {

/// How a scan looks from afar: how its points are distributed over ranges that grow by 30 % from step to
/// step, from half a metre on. The same however the sensor is turned, as far as it sees the same then.
class ScanSignature {
public:
    ScanSignature() = default;
    explicit ScanSignature(PointSpan<float> points);
    /// 0 where two scans look the same; about 1 where they are of different places.
    float distance(const ScanSignature &other) const;

private:
    static constexpr std::size_t last = 19; // 73 m and more
    std::array<float, last + 1> parts_{};
};

/// Which scans of a drive may show one place.
struct LoopCandidateSettings {
    double leastWay = 8; ///< of the drive between two scans of a loop; metres
    double reach = 2;    ///< scans nearer than this show the same; metres
    double maxDrift = 6; ///< that the nearest scans may be farther apart, as the drive is in doubt; metres
    double passWay = 2;  ///< of the drive between two passes; metres
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
    void add(const Scan &scan, const Pose2D &pose);
    /// All scans are thought to be elsewhere.
    void move(const std::vector<Pose2D> &poses);
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
        return settings.reach + std::min(scans_[to].doubt - scans_[from].doubt, settings.maxDrift);
    }
    /// Where the last scan is near `here`: the nearest scans of earlier passes, one of each, so many at most.
    /// The drive is in doubt since each of them, or no more than since scan `sure`. Valid until the next
    /// call.
    const std::vector<std::size_t> &nearest(const Pose2D &here, std::size_t most, std::size_t sure,
                                            const LoopCandidateSettings &settings);

    /// A scan that was found far from where the last one is thought to be.
    struct Far {
        std::size_t scan; ///< the one that looks most alike
        std::size_t among;
    };
    /// Of all places where the last scan may be, as the drive went on without a loop since scan `sure`; but
    /// for the scans `except`. Nothing where the nearest ones are enough.
    std::optional<Far> far(std::size_t sure, const std::vector<std::size_t> &except,
                           const LoopCandidateSettings &settings) const;

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
    Eigen::Matrix2d spreadSince(std::size_t from) const;

    std::vector<Scan> scans_;
    std::vector<Pose2D> poses_;
    DriveUncertainty uncertainty_;
    SegmentGrid grid_{4};
    std::vector<Near> near_;
    std::vector<std::size_t> chosen_;
};

/// Settings of LoopAgreement: when two loops tell the same. A way is that of the drive.
struct LoopAgreementSettings {
    double within = 30;                    ///< way on which loops are asked, at both of their ends; metres
    double along = 15;                     ///< least way on which they agree; metres
    double apart = 1;                      ///< least way between two that count; metres
    double missXY = 0.3, missAlpha = 0.06; ///< by how much two may miss each other; metres, radians
    double missPart = 0.03;                ///< and by so much of the ways between them
};

/// Loops that are not believed before others, found on the same stretch of the drive, tell the same.
class LoopAgreement {
public:
    LoopAgreementSettings settings;

    /// An end of a loop, as the drive alone led there.
    struct End {
        Transformation2D pose;
        double way; ///< since the start of the drive; metres
    };
    /// A loop that waits for others, and its two ends.
    struct Waiting {
        PoseConstraint loop;
        End from, to;
    };

    /// Takes the next loop. Where it and those that agree with it are at least `enough` they are given, and
    /// forgotten; else nothing is.
    std::vector<PoseConstraint> add(const PoseConstraint &loop, const End &from, const End &to,
                                    std::size_t enough);
    /// The last one that waits, where the drive went on for no more than `within` since.
    std::optional<Waiting> newest(double way) const {
        const bool isAny = !waiting_.empty() && way - waiting_.back().to.way <= settings.within;
        return isAny ? std::optional(waiting_.back()) : std::nullopt;
    }
    void clear() { waiting_.clear(); }

private:
    // Whether both lead from the first one's begin to the second one's end alike.
    bool agree(const Waiting &a, const Waiting &b) const;

    std::vector<Waiting> waiting_;
};

/// Whether the drive allows a loop. Where rooms are alike, loops that are off by the same way agree with each
/// other: each has to agree with the drive alone first. Where the sensor was put elsewhere on the way, which
/// tells next to nothing, it has to agree with the nearest loop that leads across, too, and with the drive
/// from there. Scans have the numbers of LoopCandidates and of the graph's poses.
class LoopGate {
public:
    /// The sensor was put elsewhere, to that scan: a later one than those before.
    void addPlaced(std::size_t scan) { placed_.push_back(scan); }
    void clear() { placed_.clear(); }
    /// Whether the sensor was put elsewhere between two scans.
    bool isAcross(std::size_t from, std::size_t to) const { return part(from) != part(to); }
    /// Where it was: of the believed loops between the same two parts the one nearest by its ways; null where
    /// there is none.
    const PoseConstraint *nearestAcross(const PoseConstraint &c, const PoseGraph &graph,
                                        const LoopCandidates &drive) const;
    /// Whether a loop with that covariance, in the frame of its first scan, misses where the drive led by no
    /// more squared standard deviations than `most`.
    bool allows(const PoseConstraint &c, const Eigen::Matrix3d &covariance, const PoseGraph &graph,
                const LoopCandidates &drive, double most) const;

private:
    // How often the sensor was put elsewhere up to that scan.
    std::ptrdiff_t part(std::size_t scan) const {
        return std::upper_bound(placed_.begin(), placed_.end(), scan) - placed_.begin();
    }
    static bool isWithin(const Transformation2D &led, const Pose2D &to, const Eigen::Matrix3d &spread,
                         double most) {
        const Eigen::Vector3d off(led.x() - to.x, led.y() - to.y,
                                  std::remainder(led.alpha() - to.theta, 2 * pi));
        return off.dot(spread.ldlt().solve(off)) <= most;
    }
    // A covariance in a frame that is turned.
    static Eigen::Matrix3d turned(const Eigen::Matrix3d &covariance, double angle) {
        Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
        turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(angle).toRotationMatrix();
        return turn * covariance * turn.transpose();
    }
    // The covariance of a pose, as that of `place`, which is rigid with it.
    static Eigen::Matrix3d at(const Eigen::Matrix3d &covariance, const Pose2D &pose, const Pose2D &place);
    // Of `place`, which is rigid with one of two scans, where the other one is certain.
    static Eigen::Matrix3d spreadAt(const Pose2D &place, std::size_t a, std::size_t b,
                                    const LoopCandidates &drive) {
        const std::size_t late = std::max(a, b);
        return at(drive.uncertainty().between(std::min(a, b), late), drive.scan(late).tracked, place);
    }

    std::vector<std::size_t> placed_; // scans to which the sensor was put, ascending
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/LoopCandidates.cpp")
