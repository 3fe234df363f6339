#pragma once

#include "common/capture/Frame.h"
#include "protocol/velodyne/ClockChoice.h"
#include "protocol/velodyne/PositionPacket.h"
#include "protocol/velodyne/TurnAssembler.h"

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

namespace hermes {

/// Of several sensors whose data packets stand in one capture, or come in on one port, takes the first. A
/// sensor is told from others by its address and by the ports that it sends from and to.
class SensorChoice {
public:
    struct Options {
        std::optional<std::uint16_t> port;    ///< only sensors that send to it
        std::optional<std::uint32_t> address; ///< only the sensor that has it
        /// Another takes the place of one that has been silent for longer; never without, unless it only
        /// sends from another port: a sensor that began anew may.
        std::optional<std::int64_t> timeout_ns;
    };
    struct Sensor {
        std::uint32_t address = 0;
        std::uint16_t from = 0; ///< the port that it sends from
        std::uint16_t port = 0; ///< that it sends to
        std::uint64_t packets = 0;
        bool wasTaken = false;
    };

    SensorChoice() = default;
    explicit SensorChoice(const Options &options)
        : options_(options) {}

    /// Whether a data packet is of the sensor that is taken.
    bool takes(const Datagram &packet);
    /// Whether the options permit its port and sender.
    bool isWanted(const Datagram &datagram) const {
        return options_.port.value_or(datagram.destinationPort) == datagram.destinationPort &&
               options_.address.value_or(datagram.source) == datagram.source;
    }
    /// Whether any other datagram can be of that sensor, as far as addresses and ports tell.
    bool mayTake(const Datagram &datagram) const;
    /// Whether it comes from the address of that sensor; as long as there is none, whether it may.
    bool isFromTaken(const Datagram &datagram) const;
    /// The packets that follow are of another time.
    void jump() { lastTaken_ns_.reset(); }

    /// All that sent data packets, wanted or not, in the order in which they did; beyond 16 each new one
    /// takes the place of the last.
    const std::vector<Sensor> &sensors() const { return sensors_; }
    /// The one of them that is taken, or null.
    const Sensor *taken() const { return taken_ ? &sensors_[*taken_] : nullptr; }

private:
    std::size_t find(const Datagram &packet);

    Options options_;
    std::vector<Sensor> sensors_;
    std::optional<std::size_t> taken_;         ///< which of the sensors
    std::optional<std::int64_t> lastTaken_ns_; ///< when the last packet of the one taken came in
};

/// Of four decimal numbers with dots between. Not with zeros before them: elsewhere such are octal.
std::optional<std::uint32_t> addressFrom(const std::string &text);
/// "192.168.1.201".
std::string addressText(std::uint32_t address);
/// "192.168.1.201:443 to port 2368".
std::string toText(const SensorChoice::Sensor &sensor);

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
        velodyne::ClockChoice clock = velodyne::ClockChoice::Gps;
    };

    LidarStream() = default;
    explicit LidarStream(const Options &options)
        : options_(options)
        , choice_(options.sensor) {}

    /// Hands a datagram to the assemblers if it is a data packet of the sensor, should be one and is damaged,
    /// or is one of a model or return mode that is not decoded: they count that. Null ones are left out.
    void take(const Datagram &datagram, std::initializer_list<velodyne::TurnAssembler *> assemblers);
    /// The datagrams that follow are of another time.
    void jump() {
        choice_.jump();
        steps_ = clockSteps();
        host_ = scan::HostClock(velodyne::stampPeriod_ns);
        isSet_ = false;
        gps_.forget();
    }

    /// How often a clock was set, by less than a second.
    std::uint64_t clockSteps() const { return steps_ + host_.steps(); }
    const SensorChoice &sensors() const { return choice_; }
    const velodyne::GpsReader &gps() const { return gps_; }
    std::uint64_t other() const { return other_; } ///< nothing that could be read, of nobody in particular
    std::uint64_t otherSensors() const { return otherSensors_; } ///< data packets of those that are not taken

private:
    bool isDamaged(const Datagram &datagram, velodyne::PacketFault fault) const;
    bool usesHost() const;
    std::optional<scan::HostClock::Time> hostTime(const Datagram &datagram);
    void follow(std::initializer_list<velodyne::TurnAssembler *> assemblers, bool usedHost);

    Options options_;
    SensorChoice choice_;
    velodyne::GpsReader gps_;
    scan::HostClock host_{velodyne::stampPeriod_ns};
    std::uint64_t steps_ = 0; ///< before the last jump
    bool isSet_ = false;      ///< a GPS has set the sensor's clock
    std::uint64_t other_ = 0, otherSensors_ = 0;
};

} // namespace hermes
