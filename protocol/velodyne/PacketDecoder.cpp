#include "protocol/velodyne/PacketDecoder.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>

namespace hermes::velodyne {

namespace {

constexpr std::int64_t hour_ns = 3600000000000;
/// A clock set anew, or a sensor started anew, shows as a jump of the offset beyond this.
constexpr std::int64_t jump_ns = 60000000000;

} // namespace

std::int64_t nearestHour(std::uint32_t stamp_us, std::int64_t reference_ns) {
    std::int64_t ahead = (std::int64_t(stamp_us) * 1000 - reference_ns) % hour_ns;
    if (ahead > hour_ns / 2)
        ahead -= hour_ns;
    if (ahead < -hour_ns / 2)
        ahead += hour_ns;
    return reference_ns + ahead;
}

std::int64_t StampClock::absolute(std::uint32_t stamp_us, std::int64_t receive_ns) {
    const std::int64_t expected_ns = following_ ? last_ns_ : receive_ns + (started_ ? offset_ns_ : 0);
    std::int64_t stamp_ns = nearestHour(stamp_us, expected_ns);
    const std::int64_t off_ns = stamp_ns - expected_ns;
    if (!following_ && (off_ns > jump_ns || off_ns < -jump_ns))
        stamp_ns = nearestHour(stamp_us, receive_ns);
    last_ns_ = stamp_ns;
    offset_ns_ = stamp_ns - receive_ns;
    started_ = true;
    return stamp_ns;
}

void StampClock::follow(std::int64_t utc_ns) {
    following_ = isSet_ = true;
    last_ns_ = utc_ns;
}

namespace {

constexpr double degree = vectorlib::pi / 180;
constexpr std::int64_t turn = 10 * azimuthSteps; // thousandths of a degree

} // namespace

Returns returnsFromText(std::string_view text) {
    return text == "last" ? Returns::Last : text == "both" ? Returns::Both : Returns::Strongest;
}

PacketDecoder::PacketDecoder(const SensorModel &model, int laser, Returns returns, bool verticalOffsets)
    : model_(&model)
    , laser_(laser == levelLaser ? model.horizonLaser : laser)
    , returns_(returns) {
    for (int i = 0; i < model.lasers; ++i) {
        const Laser &l = model.laser[i];
        beams_[i] = {std::cos(l.elevation_deg * degree), std::sin(l.elevation_deg * degree),
                     verticalOffsets ? l.verticalOffset_mm / 1000 : 0,
                     i / model.lasersAtOnce * model.laserPeriod_ns,
                     (turn + std::llround(l.azimuthOffset_deg * 1000)) % turn * model.blockPeriod_ns()};
    }
}

void PacketDecoder::decode(const DataPacket &packet, int group, int firing, std::int64_t packetStamp_ns,
                           std::vector<Point> &points) const {
    // In a dual-return packet the even block holds the last return and the odd one the strongest.
    const int returns = packet.returns();
    const int first = group * returns + (returns == 2 && returns_ == Returns::Strongest ? 1 : 0);
    const int last = group * returns + (returns == 2 && returns_ != Returns::Last ? 1 : 0);
    const std::int64_t gap = azimuthGap(packet, group);
    const std::int64_t period_ns = model_->blockPeriod_ns();
    const int firstLaser = laser_ == allLasers ? 0 : laser_;
    const int lastLaser = laser_ == allLasers ? model_->lasers - 1 : std::min(laser_, model_->lasers - 1);
    for (int laser = firstLaser; laser <= lastLaser; ++laser) {
        const int slot = firing * model_->lasers + laser;
        const Beam &beam = beams_[laser];
        const std::int64_t after_ns = firing * model_->firingPeriod_ns + beam.after_ns;
        for (int block = first; block <= last; ++block) {
            const std::uint16_t counts = packet.distance(block, slot);
            const bool repeated = block > first && counts == packet.distance(first, slot);
            if (counts == 0 || repeated)
                continue;
            Point point;
            point.stamp_ns = packetStamp_ns + group * period_ns + after_ns;
            // Thousandths of a degree times the period: whole numbers, rounded once by the division.
            const std::int64_t azimuth =
                10 * (packet.azimuth(group * returns) * period_ns + gap * after_ns) + beam.azimuthOffset;
            point.azimuth = double(azimuth % (turn * period_ns)) / double(1000 * period_ns);
            point.range = counts / model_->distanceCounts;
            const double horizontal = point.range * beam.cosElevation;
            point.x = horizontal * std::cos(point.azimuth * degree);
            point.y = -horizontal * std::sin(point.azimuth * degree); // the sensor counts clockwise
            point.z = point.range * beam.sinElevation + beam.height;
            point.laser = std::uint8_t(laser);
            point.intensity = packet.intensity(block, slot);
            points.push_back(point);
        }
    }
}

int azimuthGap(const DataPacket &packet, int group) {
    const int from = group < packet.groups() - 1 ? group : group - 1;
    const int azimuth = packet.azimuth(from * packet.returns());
    const int next = packet.azimuth((from + 1) * packet.returns());
    const int gap = (next - azimuth + azimuthSteps) % azimuthSteps;
    return gap <= maximumGap ? gap : 0;
}

} // namespace hermes::velodyne
