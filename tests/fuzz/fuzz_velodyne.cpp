#include "tests/fuzz/FuzzInput.h"

#include "protocol/velodyne/Hdl32e.h"
#include "protocol/velodyne/PositionPacket.h"
#include "protocol/velodyne/TurnAssembler.h"

using namespace hermes::velodyne;

namespace {

/// A packet that is right but for what the input says.
std::array<std::uint8_t, packetSize> takePacket(FuzzInput &in) {
    DataPacketWriter writer;
    const auto azimuth = in.take<std::uint16_t>(), step = in.take<std::uint16_t>(),
               distance = in.take<std::uint16_t>();
    for (int block = 0; block < blocksPerPacket; ++block) {
        writer.setAzimuth(block, std::uint16_t((azimuth + block * step) % azimuthSteps));
        for (int slot = 0; slot < slotsPerBlock; ++slot)
            writer.setReturn(block, slot, std::uint16_t(distance * (slot + block)), 1);
    }
    constexpr ReturnMode modes[] = {ReturnMode::Strongest, ReturnMode::Last, ReturnMode::Dual};
    constexpr Model models[] = {Model::Hdl32e, Model::Vlp16};
    const auto kind = in.take<std::uint8_t>();
    writer.setTail(in.take<std::uint32_t>() % stampPeriod_us, modes[kind % 3], models[kind / 3 % 2]);
    auto bytes = writer.bytes();
    for (auto patches = in.take<std::uint8_t>() % 8; patches > 0; --patches) {
        const auto at = in.take<std::uint16_t>() % packetSize;
        bytes[at] = in.take<std::uint8_t>();
    }
    return bytes;
}

/// A position packet that is locked to a GPS, with any text and what else the input says.
void feedPosition(GpsReader &gps, FuzzInput &in) {
    PositionPacket packet;
    packet.stamp_us = in.take<std::uint32_t>() % stampPeriod_us;
    packet.pps = Pps::Locked;
    packet.nmea = in.bytes(in.take<std::uint8_t>() % maximumNmea);
    auto bytes = encodePosition(packet);
    bytes[in.take<std::uint16_t>() % bytes.size()] = in.take<std::uint8_t>();
    const auto size =
        in.take<std::uint8_t>() % 8 == 0 ? in.take<std::uint16_t>() % bytes.size() : bytes.size();
    gps.feed(bytes.data(), size);
    FUZZ_REQUIRE(gps.state().packet.nmea.size() <= maximumNmea);
    FUZZ_REQUIRE(!gps.state().utc_ns || (gps.state().valid && *gps.state().utc_ns > 0));
}

void requireSound(const Turn &turn) {
    FUZZ_REQUIRE(turn.firings > 0);
    FUZZ_REQUIRE(turn.points.size() <= std::size_t(turn.firings) * slotsPerBlock * 2);
    for (const Point &p : turn.points) {
        FUZZ_REQUIRE(p.azimuth >= 0 && p.azimuth < 360 && p.range > 0 && p.laser < slotsPerBlock);
        FUZZ_REQUIRE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
}

} // namespace

/// Any packets at any time give turns whose points are finite; every packet is counted once.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    TurnAssembler::Options options;
    options.laser = in.take<std::uint8_t>() % (slotsPerBlock + 2) + PacketDecoder::levelLaser;
    options.returns = Returns(in.take<std::uint8_t>() % 3);
    options.firingStep = in.take<std::uint8_t>() + 1u;
    constexpr Model models[] = {Model::Blank, Model::Hdl32e, Model::Vlp16};
    options.model = models[in.take<std::uint8_t>() % 3];
    std::int64_t now_ns = 0;
    TurnAssembler assembler(options, requireSound);
    GpsReader gps;
    std::uint64_t packets = 0, positions = 0;
    for (; in.left() > 0 && packets < 200; ++packets) {
        const auto kind = in.take<std::uint8_t>();
        if (kind == 0)
            now_ns = in.take<std::uint32_t>() * std::int64_t(1000000000); // all that PcapReader lets pass
        else
            now_ns += kind * hdl32e.packetPeriod_ns() / 4;
        if (kind % 16 == 2) {
            feedPosition(gps, in);
            assembler.follow(gps.state().utc_ns);
            ++positions;
        }
        if (kind % 16 == 3)
            assembler.jump();
        if (kind % 16 == 1) {
            const std::string raw = in.bytes(in.take<std::uint16_t>());
            assembler.feed(reinterpret_cast<const std::uint8_t *>(raw.data()), raw.size(), now_ns);
        } else {
            const auto packet = takePacket(in);
            assembler.feed(packet.data(), packet.size(), now_ns);
        }
    }
    assembler.finish();
    FUZZ_REQUIRE(gps.counts().packets == positions);
    FUZZ_REQUIRE(assembler.counts().packets == packets && assembler.rpm() >= 0 && assembler.rpm() < 1e9);
    return 0;
}
