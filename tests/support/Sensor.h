#pragma once

#include "common/capture/Frame.h"
#include "protocol/velodyne/DataPacket.h"
#include "protocol/velodyne/Hdl32e.h"
#include "protocol/velodyne/Vlp16.h"

/// Packets of a sensor that turns evenly, 0.17 degrees a block, and sees a wall 5 m away all around.
class Sensor {
public:
    std::int64_t start_ns = 1700000000000000000;
    int azimuthStep = 17; ///< hundredths of a degree
    bool dual = false;
    const hermes::velodyne::SensorModel *model = &hermes::velodyne::hdl32e;

    std::array<std::uint8_t, hermes::velodyne::packetSize> packet(int number) const {
        using namespace hermes::velodyne;
        DataPacketWriter writer;
        const int returns = dual ? 2 : 1;
        for (int block = 0; block < blocksPerPacket; ++block) {
            const int group = number * blocksPerPacket / returns + block / returns;
            writer.setAzimuth(block, std::uint16_t((35000 + group * azimuthStep) % azimuthSteps));
            const int distance = dual && block % 2 == 0 ? 2600 : 2500;
            for (int slot = 0; slot < slotsPerBlock; ++slot)
                writer.setReturn(block, slot, std::uint16_t(distance), std::uint8_t(slot));
        }
        writer.setTail(std::uint32_t(stamp(number) / 1000 % stampPeriod_us),
                       dual ? ReturnMode::Dual : ReturnMode::Strongest, model->model);
        return writer.bytes();
    }
    std::int64_t stamp(int number) const {
        return start_ns +
               number * hermes::velodyne::blocksPerPacket * model->blockPeriod_ns() / (dual ? 2 : 1);
    }
};

/// A datagram as a sensor sends it, around a payload that somebody else keeps.
template <typename Bytes>
hermes::Datagram sensorDatagram(const Bytes &payload, std::int64_t stamp_ns) {
    hermes::Datagram datagram;
    datagram.stamp_ns = stamp_ns;
    datagram.source = 0xC0A801C8; // 192.168.1.200
    datagram.destination = 0xFFFFFFFF;
    datagram.sourcePort = datagram.destinationPort = hermes::velodyne::dataPort;
    datagram.payload = reinterpret_cast<const std::uint8_t *>(payload.data());
    datagram.size = std::size_t(payload.size());
    return datagram;
}
