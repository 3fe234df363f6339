#include "daemons/simulator/LidarModel.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/observation/Observer.h"

#include <algorithm>

namespace hermes::simulator {

namespace {

using velodyne::hdl32e;
constexpr double degree = vectorlib::pi / 180;
constexpr std::uint8_t wallIntensity = 100; // made up, to tell them apart
constexpr std::uint8_t floorIntensity = 40;
constexpr std::uint8_t personIntensity = 60;
constexpr int normalBits = 12; // a table that stays in the first cache
constexpr std::size_t normals = 1 << normalBits;
constexpr double halfSector = 0.05; // radians; single rays that follow one another lie in one

struct Beam {
    double cosine;
    double tangent; ///< of the elevation
    double offset;  ///< of the laser above the sensor's origin; metres
};

/// Part of the way to the next block's azimuth that passes from the first to the last laser.
constexpr double firingShare =
    double((hdl32e.lasers - 1) * hdl32e.laserPeriod_ns) / double(hdl32e.firingPeriod_ns);

std::array<Beam, hdl32e.lasers> makeBeams() {
    std::array<Beam, hdl32e.lasers> beams;
    for (int i = 0; i < hdl32e.lasers; ++i) {
        const velodyne::Laser &laser = hdl32e.laser[i];
        const double elevation = laser.elevation_deg * degree;
        beams[i] = {std::cos(elevation), std::tan(elevation), laser.verticalOffset_mm / 1000};
    }
    return beams;
}

const std::array<Beam, hdl32e.lasers> beams = makeBeams();

} // namespace

LidarModel::LidarModel(const std::vector<vectorlib::LineSegment2D<double>> &walls, const Options &options,
                       std::uint64_t seed)
    : walls_(walls)
    , options_(options)
    , random_(seed)
    , normal_(normals) {
    std::normal_distribution<float> normal;
    for (std::size_t i = 0; i < normals; i += 2) { // in pairs, so that their mean is 0
        normal_[i] = normal(random_);
        normal_[i + 1] = -normal_[i];
    }
}

void LidarModel::fire(const vectorlib::Pose2D &pose, const People &people, double azimuth, double gap,
                      velodyne::DataPacketWriter &packet, int block) {
    // The head turns clockwise: from left to right.
    const double first = pose.theta - azimuth * degree;
    const double last = first - gap * firingShare * degree;
    const Vector left(std::cos(first), std::sin(first)), right(std::cos(last), std::sin(last));
    selectWalls({pose.x, pose.y}, left, right);
    selectPeople(people, {pose.x, pose.y}, left, right);
    const Vector step = (right - left) / (hdl32e.lasers - 1); // the arc is so short that its chord serves
    for (int laser = 0; laser < hdl32e.lasers; ++laser)
        measure(laser, left + step * laser, packet, block);
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

void LidarModel::selectPeople(const People &people, Vector position, Vector left, Vector right) {
    peopleInReach_.clear();
    for (const People::Person &person : people.all()) {
        const Vector centre = person.position - position;
        const bool beside = left.cross(centre) > People::radius || right.cross(centre) < -People::radius;
        if (!beside && left.dot(centre) > 0)
            peopleInReach_.push_back(centre);
    }
}

double LidarModel::wallDistance(Vector direction) const {
    double distance = vectorlib::noHit;
    for (const Wall &wall : inReach_)
        distance = std::min(distance, vectorlib::rayDistance(direction, wall.begin, wall.end));
    return distance;
}

/// To the near side of the nearest person; a sensor inside one sees nothing of it.
double LidarModel::personDistance(Vector direction) const {
    double distance = vectorlib::noHit;
    for (const Vector &centre : peopleInReach_) {
        const double aside = direction.cross(centre), ahead = direction.dot(centre);
        const double depth = People::radius * People::radius - aside * aside;
        if (depth > 0 && ahead > std::sqrt(depth))
            distance = std::min(distance, ahead - std::sqrt(depth));
    }
    return distance;
}

bool LidarModel::chance(double share) {
    return share > 0 && std::uniform_real_distribution<double>()(random_) < share;
}

// To draw from the distribution itself would take as long as all the rest of a ray.
double LidarModel::noise() {
    if (bitsLeft_ < normalBits) {
        bits_ = random_();
        bitsLeft_ = 64;
    }
    const std::size_t drawn = bits_ % normals;
    bits_ >>= normalBits;
    bitsLeft_ -= normalBits;
    return double(normal_[drawn]);
}

void LidarModel::measure(int laser, Vector direction, velodyne::DataPacketWriter &packet, int block) {
    const Beam &beam = beams[laser];
    const double height = options_.sensorHeight + beam.offset;
    const double wall = wallDistance(direction), person = personDistance(direction);
    const bool meetsPerson = person < wall && height + person * beam.tangent <= People::height;
    double horizontal = meetsPerson ? person : wall;
    std::uint8_t intensity = meetsPerson ? personIntensity : wallIntensity;
    if (beam.tangent < 0 && height / -beam.tangent < horizontal) {
        horizontal = height / -beam.tangent;
        intensity = floorIntensity;
    } else if (!meetsPerson && height + wall * beam.tangent > options_.wallHeight) {
        horizontal = vectorlib::noHit;
    }
    const double range = measured(horizontal / beam.cosine);
    packet.setReturn(block, laser, range > 0 ? velodyne::toDistanceCounts(range) : 0,
                     range > 0 ? intensity : 0);
}

/// What the sensor tells of a range, 0 when nothing returns.
double LidarModel::measured(double range) {
    if (range <= options_.maxRange)
        range += options_.sigma * noise();
    if (chance(options_.outliers))
        range *= std::uniform_real_distribution<double>(0, 2)(random_);
    const bool returns =
        range >= options_.minRange && range <= options_.maxRange && !chance(options_.dropouts);
    return returns ? range : 0;
}

void LidarModel::stand(const vectorlib::Pose2D &pose, const People &people) {
    pose_ = pose;
    people_ = &people;
    sector_ = {0, 0};
}

double LidarModel::range(double direction) {
    const double angle = pose_.theta + direction;
    const Vector ray(std::cos(angle), std::sin(angle));
    if (ray.dot(sector_) < std::cos(halfSector)) {
        sector_ = ray;
        const Vector aside = Vector(-ray.y, ray.x) * std::tan(halfSector);
        selectWalls({pose_.x, pose_.y}, ray + aside, ray - aside);
        selectPeople(*people_, {pose_.x, pose_.y}, ray + aside, ray - aside);
    }
    const double wall = options_.sensorHeight <= options_.wallHeight ? wallDistance(ray) : vectorlib::noHit;
    const double person = options_.sensorHeight <= People::height ? personDistance(ray) : vectorlib::noHit;
    return measured(std::min(wall, person));
}

} // namespace hermes::simulator
