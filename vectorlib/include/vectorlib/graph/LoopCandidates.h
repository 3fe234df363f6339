#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/graph/DriveUncertainty.h"
#include "vectorlib/graph/ScanSignature.h"

#include <algorithm>
#include <optional>
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
        return settings.reach + std::min(scans_[to].doubt - scans_[from].doubt, settings.mostDrift);
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

    void enter(std::size_t k);
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

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/LoopCandidates.cpp")
