#include "daemons/simulator/Simulation.h"

#include <cmath>

namespace hermes::simulator {

namespace {

constexpr double firingPeriod = velodyne::hdl32e.firingPeriod_ns * 1e-9; // seconds
constexpr double packetPeriod = firingPeriod * velodyne::blocksPerPacket;

std::vector<vectorlib::LineSegment2D<double>> wallsOf(const World &world) {
    std::vector<vectorlib::LineSegment2D<double>> walls;
    for (const World::Edge &e : world.edges)
        walls.emplace_back(vectorlib::Vector2D<double>(e.x1, e.y1), vectorlib::Vector2D<double>(e.x2, e.y2));
    return walls;
}

} // namespace

Simulation::Simulation(const World &world, const Options &options, std::int64_t start_ns)
    : follower_(PosePath(world.poses, options.speed, options.turnRate), options.acceleration / options.speed)
    , drivetrain_(options.drivetrain)
    , body_(wallsOf(world), options.radius)
    , people_(world.people, options.radius)
    , lidar_(wallsOf(world), options.lidar, options.seed)
    , gps_(options.gps)
    , scannerRays_(wallsOf(world), options.lidar, options.seed + 1)
    , scanner_(makeScanner(options.scannerModel, options.scanner))
    , scannerPose_(options.scannerPose)
    , gap_(options.rpm / 60 * 360 * firingPeriod)
    , lidarGps_(options.lidarGps)
    , lidarClock_s_(options.lidarClock_s)
    , lidarDrift_(options.lidarDrift_ppm * 1e-6)
    , start_ns_(start_ns) {
    for (velodyne::MotionChip &chip : position_.chips)
        chip.temperature_c = 25; // they stand still: how their axes lie is not published
}

bool Simulation::drive() {
    if (placed_ || follower_.path().length() <= 0 || follower_.isFinished())
        return false;
    follower_.drive();
    return true;
}

void Simulation::advanceWheels() {
    rolling_ = drivetrain_.advance(packetPeriod);
    const bool following = follower_.isDriving() || follower_.rate() > 0;
    if (placed_ || following || !drivetrain_.isMoving())
        return;
    place_ = follower_.pose();
    placed_ = true;
}

void Simulation::advancePose(double seconds) {
    const bool rolls = rolling_.vx != 0 || rolling_.vy != 0 || rolling_.omega != 0;
    if (!placed_)
        follower_.advance(seconds);
    else if (rolls) // one that stands is where it was put, be it in a wall
        place_ = body_.move(place_, rolling_, seconds, people_);
    people_.advance(seconds, {pose().x, pose().y});
}

/// By the sensor's own clock, microseconds of the hour.
std::uint32_t Simulation::lidarStamp_us() const {
    const double ahead_s = lidarClock_s_ + lidarDrift_ * double(now_ns() - start_ns_) * 1e-9;
    const std::int64_t ahead_us = lidarGps_ ? 0 : std::llround(ahead_s * 1e6);
    return std::uint32_t((now_ns() / 1000 + ahead_us) % velodyne::stampPeriod_us);
}

const std::array<std::uint8_t, velodyne::packetSize> &Simulation::nextPacket() {
    advanceWheels();
    packet_.setTail(lidarStamp_us());
    for (int block = 0; block < velodyne::blocksPerPacket; ++block) {
        const double azimuth = std::fmod(double(firings_) * gap_, 360.0);
        packet_.setAzimuth(block, std::uint16_t(std::lround(azimuth * 100) % velodyne::azimuthSteps));
        lidar_.fire(pose(), people_, azimuth, gap_, packet_, block);
        advancePose(firingPeriod);
        ++firings_;
    }
    return packet_.bytes();
}

std::array<std::uint8_t, velodyne::positionPacketSize> Simulation::positionPacket() {
    position_.stamp_us = lidarStamp_us();
    position_.pps = lidarGps_ ? gps_.pps() : velodyne::Pps::Absent;
    position_.nmea = lidarGps_ ? gps_.lidarSentence() : std::string();
    return encodePosition(position_);
}

std::string_view Simulation::scannerBytes() {
    if (!scanner_)
        return {};
    scannerRays_.stand(pose() * scannerPose_, people_);
    return scanner_->take(now_ns(), [this](double angle) { return scannerRays_.range(angle); });
}

void Simulation::skip(std::uint64_t packets) {
    for (std::uint64_t i = 0; i < packets; ++i) {
        advanceWheels();
        for (int block = 0; block < velodyne::blocksPerPacket; ++block)
            advancePose(firingPeriod);
    }
    firings_ += packets * velodyne::blocksPerPacket;
}

Simulation::Truth Simulation::truth() const {
    const double length = follower_.path().length();
    Truth truth;
    truth.stamp_ns = now_ns();
    truth.pose = pose();
    truth.twist = placed_ ? rolling_ : follower_.twist();
    truth.progress = !placed_ && length > 0 ? follower_.progress() / length : 0;
    truth.driving = follower_.isDriving() || follower_.rate() > 0;
    truth.finished = !placed_ && length > 0 && follower_.isFinished();
    truth.touching = placed_ && body_.isTouching();
    return truth;
}

} // namespace hermes::simulator
