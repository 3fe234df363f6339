#include "daemons/simulator/LidarModel.h"

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/observation/Ray.h"

#include <algorithm>

namespace hermes {

namespace {

constexpr double degree = vectorlib::pi / 180;
constexpr std::uint8_t wallIntensity = 100; // made up, to tell the two apart
constexpr std::uint8_t floorIntensity = 40;

struct Beam {
    double cosine;
    double tangent; ///< of the elevation
    double offset;  ///< of the laser above the sensor's origin; metres
};

std::array<Beam, velodyne::lasers> makeBeams() {
    std::array<Beam, velodyne::lasers> beams;
    for (int laser = 0; laser < velodyne::lasers; ++laser) {
        const double elevation = velodyne::elevation_deg[laser] * degree;
        beams[laser] = {std::cos(elevation), std::tan(elevation), velodyne::verticalOffset_mm[laser] / 1000};
    }
    return beams;
}

const std::array<Beam, velodyne::lasers> beams = makeBeams();

} // namespace

LidarModel::LidarModel(const std::vector<vectorlib::LineSegment2D<double>> &walls, const Options &options,
                       std::uint64_t seed)
    : walls_(walls)
    , options_(options)
    , random_(seed) {}

void LidarModel::fire(const vectorlib::Pose2D &pose, double azimuth, double gap,
                      velodyne::DataPacketWriter &packet, int block) {
    // The head turns clockwise: from left to right.
    const double first = pose.theta - azimuth * degree;
    const double last = first - gap * velodyne::laserGap * (velodyne::lasers - 1) * degree;
    const Vector left(std::cos(first), std::sin(first)), right(std::cos(last), std::sin(last));
    selectWalls({pose.x, pose.y}, left, right);
    const Vector step = (right - left) / (velodyne::lasers - 1); // the arc is so short that its chord serves
    for (int laser = 0; laser < velodyne::lasers; ++laser)
        measure(laser, wallDistance(left + step * laser), packet, block);
}

void LidarModel::selectWalls(Vector position, Vector left, Vector right) {
    inReach_.clear();
    for (const auto &wall : walls_) {
        const Vector begin = wall.begin() - position, end = wall.end() - position;
        const bool leftOfAll = left.cross(begin) > 0 && left.cross(end) > 0;
        const bool rightOfAll = right.cross(begin) < 0 && right.cross(end) < 0;
        const bool behind = left.dot(begin) < 0 && left.dot(end) < 0;
        if (!leftOfAll && !rightOfAll && !behind)
            inReach_.push_back({begin, end});
    }
}

double LidarModel::wallDistance(Vector direction) const {
    double distance = vectorlib::noHit;
    for (const Wall &wall : inReach_)
        distance = std::min(distance, vectorlib::rayDistance(direction, wall.begin, wall.end));
    return distance;
}

bool LidarModel::chance(double share) {
    return share > 0 && std::uniform_real_distribution<double>()(random_) < share;
}

void LidarModel::measure(int laser, double wallDistance, velodyne::DataPacketWriter &packet, int block) {
    const Beam &beam = beams[laser];
    const double height = options_.sensorHeight + beam.offset;
    double horizontal = wallDistance;
    std::uint8_t intensity = wallIntensity;
    if (beam.tangent < 0 && height / -beam.tangent < wallDistance) {
        horizontal = height / -beam.tangent;
        intensity = floorIntensity;
    } else if (height + wallDistance * beam.tangent > options_.wallHeight) {
        horizontal = vectorlib::noHit;
    }
    double range = horizontal / beam.cosine;
    if (range <= options_.maxRange)
        range += options_.sigma * normal_(random_);
    if (chance(options_.outliers))
        range *= std::uniform_real_distribution<double>(0, 2)(random_);
    const bool returns =
        range >= options_.minRange && range <= options_.maxRange && !chance(options_.dropouts);
    packet.setReturn(block, laser, returns ? velodyne::toDistanceCounts(range) : 0, returns ? intensity : 0);
}

} // namespace hermes
