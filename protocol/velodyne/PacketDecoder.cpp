#include "protocol/velodyne/PacketDecoder.h"

#include <cmath>

namespace hermes::velodyne {

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

} // namespace

PacketDecoder::PacketDecoder(int laser, Returns returns)
    : firstLaser_(laser == allLasers ? 0 : laser)
    , lastLaser_(laser == allLasers ? lasers - 1 : laser)
    , returns_(returns) {
    for (int i = 0; i < lasers; ++i) {
        cosElevation_[i] = std::cos(elevation_deg[i] * degree);
        sinElevation_[i] = std::sin(elevation_deg[i] * degree);
    }
}

void PacketDecoder::decode(const DataPacket &packet, int firing, std::int64_t packetStamp_ns,
                           std::vector<Point> &points) const {
    // In a dual-return packet the even block holds the last return and the odd one the strongest.
    const int returns = packet.returns();
    const int firstBlock = firing * returns + (returns == 2 && returns_ == Returns::Strongest ? 1 : 0);
    const int lastBlock = firing * returns + (returns == 2 && returns_ != Returns::Last ? 1 : 0);
    const double gap = azimuthGap(packet, firing);
    for (int laser = firstLaser_; laser <= lastLaser_; ++laser) {
        for (int block = firstBlock; block <= lastBlock; ++block) {
            const std::uint16_t counts = packet.distance(block, laser);
            const bool repeated = block > firstBlock && counts == packet.distance(firstBlock, laser);
            if (counts == 0 || repeated)
                continue;
            double azimuth = packet.azimuth(firing * returns) + gap * laserGap * laser;
            azimuth = (azimuth >= azimuthSteps ? azimuth - azimuthSteps : azimuth) * 0.01;
            Point point;
            point.stamp_ns = packetStamp_ns + firing * firingPeriod_ns + laser * laserPeriod_ns;
            point.azimuth = azimuth;
            point.range = counts * distanceUnit;
            const double horizontal = point.range * cosElevation_[laser];
            point.x = horizontal * std::cos(azimuth * degree);
            point.y = -horizontal * std::sin(azimuth * degree); // the sensor counts clockwise
            point.z = point.range * sinElevation_[laser];
            point.laser = std::uint8_t(laser);
            point.intensity = packet.intensity(block, laser);
            points.push_back(point);
        }
    }
}

int azimuthGap(const DataPacket &packet, int firing) {
    const int from = firing < packet.firings() - 1 ? firing : firing - 1;
    const int azimuth = packet.azimuth(from * packet.returns());
    const int next = packet.azimuth((from + 1) * packet.returns());
    const int gap = (next - azimuth + azimuthSteps) % azimuthSteps;
    return gap <= maximumGap ? gap : 0;
}

} // namespace hermes::velodyne
