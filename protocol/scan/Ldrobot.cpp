#include "protocol/scan/Ldrobot.h"

#include "protocol/scan/LittleEndian.h"

#include <array>
#include <cmath>

namespace hermes::scan {
namespace {

constexpr std::size_t packetSize = 47;
constexpr int packetBeams = 12;
constexpr int stampPeriod_ms = 30000;
constexpr std::int64_t ms = 1000000;

constexpr std::array<std::uint8_t, 256> makeCrcTable() {
    std::array<std::uint8_t, 256> table{};
    for (int value = 0; value < 256; ++value) {
        int crc = value;
        for (int bit = 0; bit < 8; ++bit)
            crc = crc & 0x80 ? (crc << 1 ^ 0x4D) & 0xFF : crc << 1;
        table[std::size_t(value)] = std::uint8_t(crc);
    }
    return table;
}

constexpr auto crcTable = makeCrcTable();

} // namespace

Ldrobot::Ldrobot(int samples_hz, int baud, RevolutionAssembler &revolutions)
    : ScannerProtocol(revolutions)
    , sample_ns_(1e9 / samples_hz)
    , byte_ns_(1e10 / baud)
    , clock_(stampPeriod_ms * ms, HostClock::Receiver::NeverJumps) {
    identity_.model = "LDROBOT";
}

void Ldrobot::jump() {
    ScannerProtocol::jump();
    stamp_ms_.reset();
    clock_ = HostClock(stampPeriod_ms * ms, HostClock::Receiver::NeverJumps);
}

/// The two bytes of its head may stand within a packet: only the checksum tells where one begins.
std::size_t Ldrobot::take(std::string_view bytes, const Arrival &arrival) {
    if (bytes[0] != 0x54 || (bytes.size() > 1 && bytes[1] != 0x2C))
        return 0;
    if (bytes.size() < packetSize)
        return more;
    const auto *const data = reinterpret_cast<const std::uint8_t *>(bytes.data());
    std::uint8_t crc = 0;
    for (std::size_t i = 0; i < packetSize - 1; ++i)
        crc = crcTable[crc ^ data[i]];
    if (crc != data[packetSize - 1]) {
        ++counts_.damaged;
        return 0;
    }
    takePacket(data, arrival, bytes.size());
    measured(arrival);
    return packetSize;
}

/// Some packets by the angle between, as the clock counts whole milliseconds; many by the clock.
void Ldrobot::tellLost(double first_deg, double step_deg, int stamp_ms) {
    if (!stamp_ms_ || step_deg <= 0)
        return;
    const double gap_deg = std::fmod(first_deg - step_deg - head_deg_ + 720 + step_deg, 360) - step_deg;
    const double passed_ms = (stamp_ms - *stamp_ms_ + stampPeriod_ms) % stampPeriod_ms;
    const double byAngle = gap_deg / (packetBeams * step_deg),
                 byClock = passed_ms * 1e6 / (packetBeams * sample_ns_) - 1;
    const double revolution = 360 / (packetBeams * step_deg); // packets
    const auto lost = std::lround(byClock > revolution / 2 ? byClock : byAngle);
    if (lost > 0)
        revolutions_.lose(std::uint64_t(lost));
}

void Ldrobot::takePacket(const std::uint8_t *bytes, const Arrival &arrival, std::size_t bytesSince) {
    const double speed_degps = word(bytes + 2), first_deg = word(bytes + 4) * 0.01;
    const double width_deg = std::fmod(word(bytes + 42) * 0.01 - first_deg + 720, 360);
    const int stamp_ms = word(bytes + 44);
    if (width_deg > 3 * speed_degps * packetBeams * sample_ns_ * 1e-9) // as the head begins to turn
        return revolutions_.lose(1);
    tellLost(first_deg, width_deg / (packetBeams - 1), stamp_ms);
    head_deg_ = first_deg + width_deg;
    stamp_ms_ = stamp_ms;
    const auto wire_ns = std::int64_t(double(bytesSince) * byte_ns_);
    const HostClock::Time end = clock_.take(stamp_ms * ms, arrival.mono_ns, wire_ns);
    revolutions_.setClockBound(end.bound_ns + 1000000);
    const double sample_ns = speed_degps > 0 ? width_deg / (packetBeams - 1) / speed_degps * 1e9 : sample_ns_;
    for (int i = 0; i < packetBeams; ++i) {
        const std::uint8_t *beam = bytes + 6 + 3 * i;
        const double angle_deg = std::fmod(first_deg + i * width_deg / (packetBeams - 1), 360);
        revolutions_.addClockwise(angle_deg, angle_deg, float(word(beam)) * 1e-3F, beam[2],
                                  end.stamp_ns - std::int64_t((packetBeams - 1 - i) * sample_ns));
    }
}

} // namespace hermes::scan
