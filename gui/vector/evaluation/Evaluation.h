#pragma once

#include "gui/vector/evaluation/MotionErrors.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/io/CarmenLog.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/io/Tum.h"

#include <functional>
#include <optional>
#include <ostream>
#include <vector>

namespace hermes::vector {

/// When two poses of a drive are the same place met again.
struct RevisitRule {
    double metres = 2;      ///< nearer to each other than this
    double degrees = 60;    ///< turned from each other by less
    std::size_t scans = 40; ///< at least so many scans apart
    double way = 15;        ///< at least so long a way apart; metres
};

/// Calls take with the numbers of the earlier and the later pose of every such pair, in the order of the
/// later. The poses are those of a drive, one after the other; metres, radians.
void forEachRevisit(const std::vector<vectorlib::Pose2D> &drive, const RevisitRule &rule,
                    const std::function<void(std::size_t earlier, std::size_t later)> &take);

/// A trajectory beside the reference poses of the log from whose scans it was made. Relative motions are
/// compared, so that neither frame matters and an error of the past does not count twice (Kuemmerle et al.,
/// On measuring the accuracy of SLAM algorithms, 2009).
class Evaluation {
public:
    /// Stamps belong to each other within this; seconds.
    static constexpr double sameStamp = 0.01;
    /// More pairs of places met again than this are thinned evenly.
    static constexpr std::size_t maxPairs = 2000000;

    /// A trajectory of as many poses as the log has scans belongs to them one by one, another one by its
    /// stamps. `name` is that of the trajectory, for messages. Throws Failure when fewer than two poses have
    /// a scan, or stamps do not tell which.
    Evaluation(const vectorlib::CarmenLog &log, const std::vector<vectorlib::StampedPose> &trajectory,
               const std::string &name);

    nlohmann::ordered_json summary() const;
    /// Throws Failure, which names both files, where this is the trajectory of another log: it turns where
    /// the reference does not, or so few poses have a scan that their turns do not show that it is this
    /// one's. Fewer than half with a scan whose turns agree are a warning.
    void expectSameDrive(const std::string &log, const std::string &trajectory, std::ostream &warnings) const;
    /// Both trajectories, laid on each other, and how far off the motions between places met again are.
    vectorlib::SvgPicture picture(const std::string &title) const;

private:
    using Point = vectorlib::Vector2D<double>;
    using Path = std::vector<Point>;
    /// A pose of the trajectory and the number of its scan.
    struct Pair {
        std::size_t scan;
        vectorlib::Pose2D pose;
    };
    static bool isOneByOne(const vectorlib::CarmenLog &log,
                           const std::vector<vectorlib::StampedPose> &trajectory);
    void pairOneByOne(const std::vector<vectorlib::StampedPose> &trajectory);
    void pairByStamps(const vectorlib::CarmenLog &log, const std::vector<vectorlib::StampedPose> &trajectory,
                      const std::string &name);
    std::optional<double> turnsMissed() const;
    void compareConsecutive() {
        for (std::size_t i = 1; i < pairs_.size(); ++i)
            consecutive_.add(referenceOf(pairs_[i - 1], pairs_[i]), motionOf(pairs_[i - 1], pairs_[i]));
    }
    void compareRevisits();
    vectorlib::Transformation2D motionOf(const Pair &from, const Pair &to) const {
        return vectorlib::Transformation2D(from.pose).inverse() * vectorlib::Transformation2D(to.pose);
    }
    vectorlib::Transformation2D referenceOf(const Pair &from, const Pair &to) const {
        return vectorlib::Transformation2D(reference_[from.scan]).inverse() *
               vectorlib::Transformation2D(reference_[to.scan]);
    }
    vectorlib::Transformation2D ontoReference() const;

    std::vector<vectorlib::Pose2D> reference_; ///< of all scans
    std::vector<Pair> pairs_;                  ///< in the order of the scans
    std::size_t poses_ = 0;                    ///< of the trajectory
    MotionErrors consecutive_, revisits_;
    std::size_t revisitPairs_ = 0;
    struct ScanError {
        double sum = 0; ///< metres
        std::size_t count = 0;
    };
    std::vector<ScanError> errorOf_; ///< of each scan that comes to a place again
};

} // namespace hermes::vector
