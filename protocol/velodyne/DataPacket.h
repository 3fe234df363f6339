#pragma once

#include "protocol/velodyne/SensorModel.h"

namespace hermes::velodyne {

/// What is wrong with the bytes of a data packet.
enum class PacketFault {
    None,
    Size,  ///< not 1206 bytes
    Flag,  ///< a block does not begin with FF EE
    Value, ///< an azimuth of 360 degrees or more, or a stamp beyond the hour
    Model, ///< a sensor or return mode that is not decoded here, or not the sensor that is expected
};

/// A list for people of the sensors and return modes that are decoded.
std::string decodedSensors();

/// Whether packets of this return mode and sensor can be decoded.
bool isDecoded(ReturnMode mode, Model model);

/// The fields of a data packet, read from bytes that somebody else keeps. Block and slot count from 0. A slot
/// holds the return of one laser; those of the second firing in a block of a VLP-16 follow those of the
/// first.
class DataPacket {
public:
    /// Checks length, flags, azimuths, stamp, mode and model. Only bytes without fault may be read by a
    /// DataPacket. expected: the sensor; Blank for any.
    static PacketFault check(const std::uint8_t *bytes, std::size_t size, Model expected = Model::Blank);

    explicit DataPacket(const std::uint8_t *bytes)
        : bytes_(bytes) {}

    /// Hundredths of a degree, clockwise seen from above, 0 to 35999: where the head was as the block began.
    std::uint16_t azimuth(int block) const { return word(block * blockSize + 2); }
    /// In counts of the sensor (SensorModel.h); 0 means no return.
    std::uint16_t distance(int block, int slot) const { return word(returnOffset(block, slot)); }
    std::uint8_t intensity(int block, int slot) const { return bytes_[returnOffset(block, slot) + 2]; }
    /// How many slots of a block have a return.
    int filledSlots(int block) const;
    /// Microseconds since the top of the hour, when the first laser of the packet fired. Some sensors count
    /// on beyond the hour.
    std::uint32_t stamp_us() const { return (word(1200) | std::uint32_t(word(1202)) << 16) % stampPeriod_us; }
    ReturnMode returnMode() const { return ReturnMode(bytes_[1204]); }
    Model model() const { return Model(bytes_[1205]); }
    /// Blocks that hold the same firings: 2 in dual return mode, else 1.
    int returns() const { return returnMode() == ReturnMode::Dual ? 2 : 1; }
    /// Groups of such blocks; the first block of group g is g * returns().
    int groups() const { return blocksPerPacket / returns(); }

private:
    static std::size_t returnOffset(int block, int slot) { return block * blockSize + 4 + 3 * slot; }
    std::uint16_t word(std::size_t offset) const {
        return std::uint16_t(bytes_[offset] | bytes_[offset + 1] << 8);
    }

    const std::uint8_t *bytes_;
};

/// A data packet under construction, all returns empty at first.
class DataPacketWriter {
public:
    DataPacketWriter();

    /// azimuth: hundredths of a degree, below 36000.
    void setAzimuth(int block, std::uint16_t azimuth);
    /// distance: counts of the sensor, 0 for no return.
    void setReturn(int block, int slot, std::uint16_t distance, std::uint8_t intensity);
    /// stamp_us: microseconds since the top of the hour.
    void setTail(std::uint32_t stamp_us, ReturnMode mode = ReturnMode::Strongest,
                 Model model = Model::Hdl32e);
    /// Empties all returns.
    void clear();

    const std::array<std::uint8_t, packetSize> &bytes() const { return bytes_; }

private:
    void setWord(std::size_t offset, std::uint16_t value);

    std::array<std::uint8_t, packetSize> bytes_;
};

/// Counts of 2 mm, as of an HDL-32E, nearest to a range in metres; 0 (no return) when it rounds to nothing or
/// lies beyond 131.07 m.
std::uint16_t toDistanceCounts(double range);

} // namespace hermes::velodyne
