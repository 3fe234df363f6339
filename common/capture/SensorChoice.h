#pragma once

#include "common/capture/Datagram.h"

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
        std::optional<std::int64_t> patience_ns;
    };
    struct Sensor {
        std::uint32_t address = 0;
        std::uint16_t from = 0; ///< the port that it sends from
        std::uint16_t port = 0; ///< that it sends to
        std::uint64_t packets = 0;
    };

    SensorChoice() = default;
    explicit SensorChoice(const Options &options)
        : options_(options) {}

    /// Whether a data packet is of the sensor that is taken.
    bool takes(const Datagram &packet);
    /// Whether the options permit its port and sender.
    bool isWanted(const Datagram &datagram) const;
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

} // namespace hermes
