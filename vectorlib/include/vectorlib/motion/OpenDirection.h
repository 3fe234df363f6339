#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/motion/Odometry.h"

#include <cmath>
#include <optional>

namespace vectorlib {

/// How well a pose is known along a direction that the walls leave open, as along a corridor: there it goes
/// by the odometry, or by the motion so far. Learns from the drive by how much the odometry errs.
class OpenDirection {
public:
    /// Below that reliability walls leave a direction open.
    static constexpr double openReliability = 0.1;

    /// A scan was taken at a pose (map frame). `isOpen`: the walls left a direction open, or showed nothing.
    /// The odometry is that of the robot during the scan, where there was any; `mount` the sensor's pose on
    /// it. A map that grows errs as the pose does by which it is drawn: there only the way along the walls
    /// beside the sensor counts.
    void follow(const Transformation2D &pose, bool isOpen, bool isByOdometry, bool grows,
                const std::optional<OdometryTrack> &odometry, double stamp, const Transformation2D &mount);
    /// The share of the way by which the odometry errs, as far as the drive tells.
    double slip() const { return slip_; }
    /// The scans told a pose so far from that of the odometry, which was taken (metres, map frame). What
    /// moves about the sensor goes to and fro; slip adds up, and so does the way of who is pushed.
    void dispute(const Vector2D<double> &off) { disputed_ = disputed_ + off; }
    /// The sensor was put somewhere, or the map was made anew: nothing is open there.
    void place() {
        deviation_ = 0;
        disputed_ = {};
        last_.reset();
        from_.reset();
    }
    /// The same at a place that somebody told, who errs by about half a metre.
    void placeAbout() {
        place();
        deviation_ = told_m;
    }
    /// Whether the scans and the odometry differ by so much that the pose is wrong by one of them.
    bool isDisputed() const { return disputed_.norm() > right_m; }
    /// How probable it is that the pose is right, within `right_m`.
    double belief() const {
        const double deviation = std::hypot(deviation_, disputed_.norm());
        return deviation > 0 ? std::erf(right_m / (std::sqrt(2.0) * deviation)) : 1;
    }

    static constexpr double right_m = 0.3; ///< by which a right pose is off at the most

private:
    static constexpr double told_m = 0.5;
    /// The share of the way by which the motion so far errs, the odometry at the least, and at first.
    static constexpr double unguided = 0.6, leastSlip = 0.02, firstSlip = 0.03;
    /// Without odometry who is driven along an open direction seems to stand: so fast that may be.
    static constexpr double unseen_mps = 0.2, longestPause_s = 1;
    static constexpr double beside_m = 3; // of a growing map: drawn on so much of the way
    static constexpr double piece_m = 1,
                            kept = 0.7; // of the way that is compared; of what was learned before

    struct From {
        std::uint64_t epoch;
        Transformation2D sensor, pose; // by the odometry, and by the scans
    };
    void learn(const Transformation2D &pose, std::uint64_t epoch, const Transformation2D &sensor);

    std::optional<Transformation2D> last_; // pose
    double lastStamp_ = 0;                 // seconds
    std::optional<From> from_;
    double deviation_ = 0, slip_ = firstSlip;
    Vector2D<double> disputed_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/motion/OpenDirection.cpp")
