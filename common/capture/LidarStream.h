#pragma once

#include "common/capture/SensorChoice.h"
#include "protocol/velodyne/GpsReader.h"
#include "protocol/velodyne/TurnAssembler.h"

#include <initializer_list>

namespace hermes {

/// The one way from datagrams to turns, whether they come in, are played or stand in a file: finds the data
/// packets of one sensor among them and lets its position packets tell the hour.
class LidarStream {
public:
    struct Options {
        SensorChoice::Options sensor;
        velodyne::Model model = velodyne::Model::Blank; ///< the sensor's; Blank for any
        /// To this port, or that of `sensor`, whatever comes should be a data packet; to others it is one
        /// when it can be read as one.
        std::uint16_t dataPort = velodyne::dataPort;
    };

    LidarStream() = default;
    explicit LidarStream(const Options &options)
        : options_(options)
        , choice_(options.sensor) {}

    /// Hands a datagram to the assemblers if it is a data packet of the sensor, should be one and is damaged,
    /// or is one of a model or return mode that is not decoded: they count that. Null ones are left out.
    void take(const Datagram &datagram, std::initializer_list<velodyne::TurnAssembler *> assemblers);
    /// The datagrams that follow are of another time.
    void jump() { choice_.jump(); }

    const SensorChoice &sensors() const { return choice_; }
    const velodyne::GpsReader &gps() const { return gps_; }
    std::uint64_t other() const { return other_; } ///< nothing that could be read, of nobody in particular
    std::uint64_t otherSensors() const { return otherSensors_; } ///< data packets of those that are not taken

private:
    bool isDamaged(const Datagram &datagram, velodyne::PacketFault fault) const;

    Options options_;
    SensorChoice choice_;
    velodyne::GpsReader gps_;
    std::uint64_t other_ = 0, otherSensors_ = 0;
};

} // namespace hermes
