#include "daemons/simulator/Simulation.h"

#include <cmath>

namespace hermes {

namespace {

constexpr double firingPeriod = velodyne::firingPeriod_ns * 1e-9; // seconds

std::vector<vectorlib::LineSegment2D<double>> wallsOf(const World &world) {
    std::vector<vectorlib::LineSegment2D<double>> walls;
    for (const World::Edge &e : world.edges)
        walls.emplace_back(vectorlib::Vector2D<double>(e.x1, e.y1), vectorlib::Vector2D<double>(e.x2, e.y2));
    return walls;
}

} // namespace

Simulation::Simulation(const World &world, const Options &options, std::int64_t start_ns)
    : follower_(PosePath(world.poses, options.speed, options.turnRate), options.acceleration / options.speed)
    , lidar_(wallsOf(world), options.lidar, options.seed)
    , gap_(options.rpm / 60 * 360 * firingPeriod)
    , start_ns_(start_ns) {}

bool Simulation::drive() {
    if (placed_ || follower_.path().length() <= 0 || follower_.isFinished())
        return false;
    follower_.drive();
    return true;
}

void Simulation::restart() {
    placed_ = false;
    follower_.halt();
    follower_.restart();
}

void Simulation::place(const vectorlib::Pose2D &pose) {
    restart();
    placed_ = true;
    place_ = pose;
}

const std::array<std::uint8_t, velodyne::packetSize> &Simulation::nextPacket() {
    packet_.setTail(std::uint32_t(now_ns() / 1000 % velodyne::stampPeriod_us));
    for (int block = 0; block < velodyne::blocksPerPacket; ++block) {
        const double azimuth = std::fmod(double(firings_) * gap_, 360.0);
        packet_.setAzimuth(block, std::uint16_t(std::lround(azimuth * 100) % velodyne::azimuthSteps));
        lidar_.fire(pose(), azimuth, gap_, packet_, block);
        follower_.advance(firingPeriod);
        ++firings_;
    }
    return packet_.bytes();
}

void Simulation::skip(std::uint64_t packets) {
    for (std::uint64_t i = 0; i < packets * velodyne::blocksPerPacket; ++i)
        follower_.advance(firingPeriod);
    firings_ += packets * velodyne::blocksPerPacket;
}

Simulation::Truth Simulation::truth() const {
    const double length = follower_.path().length();
    Truth truth;
    truth.stamp_ns = now_ns();
    truth.pose = pose();
    truth.twist = placed_ ? Twist() : follower_.twist();
    truth.progress = !placed_ && length > 0 ? follower_.progress() / length : 0;
    truth.driving = follower_.isDriving() || follower_.rate() > 0;
    truth.finished = !placed_ && length > 0 && follower_.isFinished();
    return truth;
}

} // namespace hermes
