#include "protocol/velodyne/DataPacket.h"

#include "protocol/velodyne/Hdl32e.h"

#include <cmath>
#include <cstdio>

namespace hermes::velodyne {

bool isDecoded(ReturnMode mode, Model model) {
    const bool blank = mode == ReturnMode::Blank && model == Model::Blank;
    const bool known = mode == ReturnMode::Strongest || mode == ReturnMode::Last || mode == ReturnMode::Dual;
    return blank || (known && model != Model::Blank && findSensorModel(model));
}

std::string decodedSensors() {
    const auto text = [](const SensorModel &model) {
        char byte[16];
        std::snprintf(byte, sizeof byte, " (%02x hex)", unsigned(model.model));
        return model.name + std::string(byte);
    };
    return "an " + listSensors(text, " or ") + " in return mode 37, 38 or 39 hex";
}

int DataPacket::filledSlots(int block) const {
    int filled = 0;
    for (int slot = 0; slot < slotsPerBlock; ++slot)
        filled += distance(block, slot) > 0;
    return filled;
}

PacketFault DataPacket::check(const std::uint8_t *bytes, std::size_t size, Model expected) {
    if (size != packetSize)
        return PacketFault::Size;
    const DataPacket packet(bytes);
    for (int block = 0; block < blocksPerPacket; ++block) {
        if (packet.word(block * blockSize) != blockFlag)
            return PacketFault::Flag;
        if (packet.azimuth(block) >= azimuthSteps)
            return PacketFault::Value;
    }
    const Model model = packet.model();
    const bool isExpected = expected == Model::Blank || model == Model::Blank || model == expected;
    return isExpected && isDecoded(packet.returnMode(), model) ? PacketFault::None : PacketFault::Model;
}

DataPacketWriter::DataPacketWriter() {
    bytes_.fill(0);
    for (int block = 0; block < blocksPerPacket; ++block)
        setWord(block * blockSize, blockFlag);
    setTail(0);
}

void DataPacketWriter::setAzimuth(int block, std::uint16_t azimuth) {
    setWord(block * blockSize + 2, azimuth);
}

void DataPacketWriter::setReturn(int block, int slot, std::uint16_t distance, std::uint8_t intensity) {
    const std::size_t offset = block * blockSize + 4 + 3 * slot;
    setWord(offset, distance);
    bytes_[offset + 2] = intensity;
}

void DataPacketWriter::setTail(std::uint32_t stamp_us, ReturnMode mode, Model model) {
    setWord(1200, std::uint16_t(stamp_us));
    setWord(1202, std::uint16_t(stamp_us >> 16));
    bytes_[1204] = std::uint8_t(mode);
    bytes_[1205] = std::uint8_t(model);
}

void DataPacketWriter::clear() {
    for (int block = 0; block < blocksPerPacket; ++block) {
        for (int slot = 0; slot < slotsPerBlock; ++slot)
            setReturn(block, slot, 0, 0);
    }
}

void DataPacketWriter::setWord(std::size_t offset, std::uint16_t value) {
    bytes_[offset] = std::uint8_t(value);
    bytes_[offset + 1] = std::uint8_t(value >> 8);
}

std::uint16_t toDistanceCounts(double range) {
    const double counts = std::round(range * hdl32e.distanceCounts);
    return counts >= 1 && counts <= 65535 ? std::uint16_t(counts) : 0;
}

} // namespace hermes::velodyne
