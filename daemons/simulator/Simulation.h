#pragma once

#include "daemons/simulator/Drivetrain.h"
#include "daemons/simulator/GpsModel.h"
#include "daemons/simulator/LidarModel.h"
#include "daemons/simulator/PosePath.h"
#include "daemons/simulator/ScannerEmulator.h"

namespace hermes::simulator {

/// The robot in its world and the packets its sensor sends, firing after firing. It follows the path of the
/// world, or goes where its wheels drive it. Knows no clock: time advances with the packets. Not for several
/// threads at once.
class Simulation {
public:
    struct Options {
        double speed = 0.8;        ///< m/s
        double acceleration = 0.8; ///< m/s^2
        double turnRate = 1.0;     ///< rad/s
        double rpm = 600;          ///< turns of the sensor's head a minute
        double radius = 0.3;       ///< of the robot's outline; metres
        bool lidarGps = true;      ///< sets the sensor's clock; without, it counts from anywhere
        double lidarClock_s = 0;   ///< of that clock, ahead of the simulator's at the start
        double lidarDrift_ppm = 0; ///< how much faster it goes
        LidarModel::Options lidar;
        GpsModel::Options gps;
        Drivetrain::Options drivetrain;
        std::string scannerModel; ///< of a 2D scanner besides; empty: none
        Pose2D scannerPose;       ///< on the robot
        ScannerOptions scanner;
        std::uint64_t seed = 1;
    };
    /// Where the robot truly is.
    struct Truth {
        std::int64_t stamp_ns = 0; ///< since the Unix epoch, of the firing that comes next
        Pose2D pose;
        Twist2D twist;
        double progress = 0; ///< share of the path, 0 to 1
        bool driving = false;
        bool finished = false;
        bool touching = false; ///< a wall or a person holds it
    };

    Simulation() = default;
    /// start_ns: time of the first firing, since the Unix epoch. The robot stands at the world's first pose.
    Simulation(const World &world, const Options &options, std::int64_t start_ns);

    /// False when there is no path, or it is at its end.
    bool drive();
    void halt() { follower_.halt(); }
    /// Back to the first pose of the path, standing.
    void restart() {
        placed_ = false;
        follower_.halt();
        follower_.restart();
    }
    /// Puts the robot anywhere, off its path; restart() brings it back.
    void place(const Pose2D &pose) {
        restart();
        placed_ = true;
        place_ = pose;
    }
    LidarModel &lidar() { return lidar_; }
    GpsModel &gps() { return gps_; }
    /// None where there is none.
    ScannerEmulator *scanner() { return scanner_.get(); }
    /// Changes what lidar and scanner measure.
    void changeLidars(const std::function<void(LidarModel &)> &change) {
        change(lidar_);
        change(scannerRays_);
    }

    /// The packet of the next twelve firings, each measured from where the robot is at its own time.
    const std::array<std::uint8_t, velodyne::packetSize> &nextPacket();
    /// The position packet that the sensor sends after its last packet.
    std::array<std::uint8_t, velodyne::positionPacketSize> positionPacket();
    /// What the GPS receiver sends now, most often nothing; valid until the next call.
    std::string_view sentences() {
        if (!gps_.isDue(now_ns()))
            return {};
        return gps_.take(now_ns(), pose(), placed_ ? rolling_ : follower_.twist());
    }
    /// What the scanner has sent since it was last asked; valid until the next call.
    std::string_view scannerBytes();
    /// Time passes without packets being made.
    void skip(std::uint64_t packets);

    const People &people() const { return people_; }
    /// The wheels take the robot off its path unless it is following it just now.
    Drivetrain &drivetrain() { return drivetrain_; }
    Truth truth() const;
    bool isPlaced() const { return placed_; }
    /// Time of the next firing: of the packet that nextPacket() makes.
    std::int64_t now_ns() const {
        return start_ns_ + std::int64_t(firings_) * velodyne::hdl32e.firingPeriod_ns;
    }

private:
    std::uint32_t lidarStamp_us() const;
    void advanceWheels();
    void advancePose(double seconds);
    Pose2D pose() const { return placed_ ? place_ : follower_.pose(); }

    PathFollower follower_;
    Drivetrain drivetrain_;
    RobotBody body_;
    Twist2D rolling_; ///< how the wheels move the robot
    People people_;
    LidarModel lidar_;
    GpsModel gps_;
    LidarModel scannerRays_;
    std::unique_ptr<ScannerEmulator> scanner_;
    Pose2D scannerPose_;
    velodyne::PositionPacket position_;
    velodyne::DataPacketWriter packet_;
    double gap_ = 0; ///< degrees a firing
    bool lidarGps_ = true;
    double lidarClock_s_ = 0, lidarDrift_ = 0;
    std::int64_t start_ns_ = 0;
    std::uint64_t firings_ = 0;
    bool placed_ = false;
    Pose2D place_;
};

} // namespace hermes::simulator
