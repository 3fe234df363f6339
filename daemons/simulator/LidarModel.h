#pragma once

#include "daemons/simulator/RobotBody.h"
#include "protocol/velodyne/DataPacket.h"
#include "protocol/velodyne/Hdl32e.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"

#include <random>
#include <vector>

namespace hermes::simulator {

/// What the simulated sensor does wrong.
struct LidarFault {
    enum class Kind { None, Silence, Loss };

    Kind kind = Kind::None;
    double share = 0; ///< of the packets that a Loss drops, 0 to 1

    /// Whether the next packet is not sent.
    template <typename Random>
    bool swallows(Random &random) const {
        if (kind == Kind::Loss)
            return std::uniform_real_distribution<double>()(random) < share;
        return kind == Kind::Silence;
    }
};

/// What an HDL-32E measures in a world of upright walls and people on a level floor. The sensor stands
/// upright at the robot's pose.
class LidarModel {
public:
    struct Options {
        double sigma = 0.01;       ///< standard deviation of the range; metres
        double sensorHeight = 0.5; ///< of its origin above the floor; metres
        double wallHeight = 2.5;   ///< beams above it return nothing; metres
        double minRange = 0.05;    ///< metres. Manual: data range 5 cm to 100 m
        double maxRange = 100;     ///< metres
        double dropouts = 0;       ///< share of the returns that do not come
        double outliers = 0;       ///< share that comes from anywhere up to twice as far
    };

    LidarModel() = default;
    LidarModel(const std::vector<vectorlib::LineSegment2D<double>> &walls, const Options &options,
               std::uint64_t seed);

    void setSigma(double sigma) { options_.sigma = sigma; }
    void setDropouts(double share) { options_.dropouts = share; }
    void setOutliers(double share) { options_.outliers = share; }
    const Options &options() const { return options_; }

    /// Measures with all lasers and fills a block. people: where they stand; azimuth: of the first laser,
    /// degrees clockwise from the heading; gap: how far the head turns until the next firing, degrees.
    void fire(const vectorlib::Pose2D &pose, const People &people, double azimuth, double gap,
              velodyne::DataPacketWriter &packet, int block);

    /// A level ray from the sensor's height: range() looks from here, as the people stand now.
    void stand(const vectorlib::Pose2D &pose, const People &people);
    /// With the noise; direction: radians from the heading, counter-clockwise. 0: nothing returns.
    double range(double direction);

private:
    using Vector = vectorlib::Vector2D<double>;
    struct Wall {
        Vector begin; ///< relative to the sensor, in the world's directions
        Vector end;
    };

    void selectWalls(Vector position, Vector left, Vector right);
    void selectPeople(const People &people, Vector position, Vector left, Vector right);
    double wallDistance(Vector direction) const;
    double personDistance(Vector direction) const;
    bool chance(double share);
    double noise();
    double measured(double range);
    void measure(int laser, Vector direction, velodyne::DataPacketWriter &packet, int block);

    std::vector<vectorlib::LineSegment2D<double>> walls_;
    Options options_;
    std::mt19937_64 random_;
    std::vector<float> normal_; ///< values of a standard normal distribution, of which each ray draws one
    std::uint64_t bits_ = 0;    ///< drawn, not yet used
    int bitsLeft_ = 0;
    std::vector<Wall> inReach_;         ///< of the current firing
    std::vector<Vector> peopleInReach_; ///< relative to the sensor
    vectorlib::Pose2D pose_;            ///< from which range() looks
    const People *people_ = nullptr;
    Vector sector_{0, 0}; ///< its middle, for which those in reach were selected
};

} // namespace hermes::simulator
