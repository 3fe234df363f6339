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
    : m_follower(PosePath(world.poses, options.speed, options.turnRate), options.acceleration / options.speed)
    , m_lidar(wallsOf(world), options.lidar, options.seed)
    , m_gap(options.rpm / 60 * 360 * firingPeriod)
    , m_start_ns(start_ns) {}

bool Simulation::drive() {
    if (m_placed || m_follower.path().length() <= 0 || m_follower.isFinished())
        return false;
    m_follower.drive();
    return true;
}

void Simulation::restart() {
    m_placed = false;
    m_follower.halt();
    m_follower.restart();
}

void Simulation::place(const vectorlib::Pose2D &pose) {
    restart();
    m_placed = true;
    m_place = pose;
}

const std::array<std::uint8_t, velodyne::packetSize> &Simulation::nextPacket() {
    m_packet.setTail(std::uint32_t(now_ns() / 1000 % velodyne::stampPeriod_us));
    for (int block = 0; block < velodyne::blocksPerPacket; ++block) {
        const double azimuth = std::fmod(double(m_firings) * m_gap, 360.0);
        m_packet.setAzimuth(block, std::uint16_t(std::lround(azimuth * 100) % velodyne::azimuthSteps));
        m_lidar.fire(pose(), azimuth, m_gap, m_packet, block);
        m_follower.advance(firingPeriod);
        ++m_firings;
    }
    return m_packet.bytes();
}

void Simulation::skip(std::uint64_t packets) {
    for (std::uint64_t i = 0; i < packets * velodyne::blocksPerPacket; ++i)
        m_follower.advance(firingPeriod);
    m_firings += packets * velodyne::blocksPerPacket;
}

Simulation::Truth Simulation::truth() const {
    const double length = m_follower.path().length();
    Truth truth;
    truth.stamp_ns = now_ns();
    truth.pose = pose();
    truth.twist = m_placed ? Twist() : m_follower.twist();
    truth.progress = !m_placed && length > 0 ? m_follower.progress() / length : 0;
    truth.driving = m_follower.isDriving() || m_follower.rate() > 0;
    truth.finished = !m_placed && length > 0 && m_follower.isFinished();
    return truth;
}

} // namespace hermes
