#pragma once

#include "common/Outcome.h"

#include <cstddef>
#include <cstdint>

namespace hermes::simulator {

/// Sends datagrams to one address. Blocks no one: what the system does not take is refused.
class UdpSender {
public:
    UdpSender() = default;
    ~UdpSender() { close(); }
    UdpSender(const UdpSender &) = delete;
    UdpSender &operator=(const UdpSender &) = delete;

    /// host is an IPv4 address.
    Outcome<void> open(const std::string &host, std::uint16_t port);
    void close();
    bool isOpen() const { return socket_ >= 0; }
    /// False when the system refuses. That nobody listens is no refusal, as with a real sensor.
    bool send(const std::uint8_t *bytes, std::size_t size);

private:
    int socket_ = -1;
};

} // namespace hermes::simulator
