#pragma once

#include "common/capture/LidarStream.h"
#include "common/capture/PcapReader.h"
#include "gui/vector/Input.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace hermes::vector {

/// Which of the sensors in a capture is read: the first, or the first that meets what is given.
struct SensorOptions {
    std::optional<std::uint16_t> port; ///< to which it sends its data packets
    std::string sender;                ///< its IPv4 address, or empty

    void addTo(CLI::App &sub);
};

/// The data packets of one sensor in a capture, whatever port they went to. Of a recording that is cut into
/// NAME-0001.pcap, NAME-0002.pcap and so on those that follow are read, too.
class LidarCapture {
public:
    /// input: to be kept while this is used. model: the sensor's; Blank for any. Throws Failure when it is no
    /// capture that can be read.
    LidarCapture(Input &input, const SensorOptions &options, velodyne::Model model = velodyne::Model::Blank,
                 velodyne::ClockChoice clock = velodyne::ClockChoice::Gps);

    /// Feeds all of them to an assembler and lets the sensor's position packets tell the hour. Gives a
    /// message about who else sent data packets and what was left out, or nothing. Throws Failure where the
    /// capture is damaged, after feeding what came before, and when the sensor is not in it.
    std::string read(velodyne::TurnAssembler &assembler);

private:
    void feed(PcapReader &reader, velodyne::TurnAssembler &assembler);
    std::string notice(const velodyne::PacketCounts &counts) const;

    std::string name_;
    SensorOptions options_;
    PcapReader reader_;
    PcapReader::Counts counts_; ///< of all files
    LidarStream stream_;
};

} // namespace hermes::vector
