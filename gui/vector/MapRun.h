#pragma once

#include "common/progress/Progress.h"
#include "gui/vector/MapSource.h"
#include "gui/vector/ProgressParts.h"
#include "vectorlib/graph/DriveParts.h"
#include "vectorlib/graph/DriveRefiner.h"
#include "vectorlib/graph/MappedDrive.h"
#include "vectorlib/io/Tum.h"
#include "vectorlib/mapping/MapLocalizer.h"
#include "vectorlib/mapping/ScanTracker.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstddef>
#include <string>

namespace hermes::vector {

/// The progress of building a map: tracking the scans, and then what follows the last one, as one work whose
/// steps take about the same time each.
class MapProgress {
public:
    explicit MapProgress(bool isFinished)
        : finishShare_(isFinished ? 0.3 : 0) {}

    /// total: 0 when it is not known. Then reading the scans tells how far it is, and tracking does not.
    void track(std::size_t scans, std::size_t total) {
        tracking_ = double(total);
        if (total > 0) // in a map that grows a scan takes longer and longer
            tell(double(scans) * std::sqrt(double(scans) / double(total)));
    }
    void begin(const std::string &stage) { progress_.rename(stage + ", step"); }
    void finish(std::size_t done, std::size_t all) {
        if (tracking_ == 0)
            progress_.update(double(done), double(all));
        else
            tell(tracking_ * (1 + finishShare_ * double(done) / double(all)));
    }

private:
    void tell(double done) { progress_.update(std::floor(done), std::floor(tracking_ * (1 + finishShare_))); }

    double tracking_ = 0;      // steps, as many as scans
    const double finishShare_; // of the time of tracking, about
    Progress progress_{"tracking, step"};
};

/// Finds the poses of a drive in a finished map and keeps account of it.
class LocalizeRun {
public:
    vectorlib::MapLocalizer localizer;

    /// `file` is how messages call the map.
    LocalizeRun(const std::vector<vectorlib::MapEdge> &map, std::string file)
        : localizer(map)
        , file_(std::move(file)) {}

    /// A scan with a fault is counted and left out.
    void take(const MapScan &scan);
    /// After the last scan. Throws Failure when no place was found: `log` is how the message calls the drive.
    void finish(const std::string &log);

    /// The scans with a pose.
    std::vector<vectorlib::StampedPose> trajectory() const;
    nlohmann::ordered_json summary() const;

private:
    std::string file_;
    std::size_t leftOut_ = 0;
};

/// Builds a map from scans and keeps account of it.
class MapRun {
public:
    vectorlib::ScanTracker tracker;
    bool closesLoops = true;

    /// A scan with a fault is counted and left out.
    void take(MapScan &scan);
    /// After the last scan, unless it is told not to close loops: where there were any, moves and refines the
    /// poses and makes the map anew from all edges (a wall keeps its id); reviews the map. `begin` takes what
    /// it does next.
    void finish(const std::function<void(const char *)> &begin, const ProgressSink &progress);

    /// For people: where the way is not known, a line each; nothing where the drive never broke.
    void warnOfBreaks(std::ostream &out) const;

    const std::vector<vectorlib::StampedPose> &trajectory() const { return trajectory_; }
    /// Of each pose of the trajectory, as ScanTracker::trust told it when the pose was tracked.
    const std::vector<double> &trust() const { return trust_; }
    /// Reference poses, one a pose of the trajectory; empty without reference.
    const std::vector<vectorlib::StampedPose> &reference() const { return reference_; }
    /// The key scans' poses as loops were closed, not yet refined, and the motions between them; without
    /// poses when loops were not to be closed.
    const vectorlib::PoseGraph &graph() const { return drive_.loops.graph(); }
    std::vector<vectorlib::MapEdge> segments() const;
    /// Counts, milliseconds a scan, walls that are there twice and, with a reference, the errors against it.
    nlohmann::ordered_json summary() const;

private:
    nlohmann::ordered_json errors() const;
    void remember(const MapScan &scan, const vectorlib::ScanReport &report);
    void rebuild(std::vector<vectorlib::Pose2D> refined, const std::function<void(const char *)> &begin,
                 ProgressParts &parts);
    nlohmann::ordered_json parts() const;
    std::vector<vectorlib::Pose2D> poses() const;
    nlohmann::ordered_json twins() const;

    vectorlib::MappedDrive drive_;
    vectorlib::DriveRefiner refine_;
    vectorlib::DriveParts divide_;
    std::vector<vectorlib::DrivePart> parts_;
    bool isRefined_ = false;
    double closeSeconds_ = 0;
    vectorlib::MapReviewCounts reviewed_;
    double reviewSeconds_ = 0;
    std::vector<vectorlib::StampedPose> trajectory_;
    std::vector<vectorlib::StampedPose> reference_;
    std::vector<double> trust_;
    std::size_t leftOut_ = 0;
};

} // namespace hermes::vector
