#pragma once

#include "common/Outcome.h"
#include "common/capture/Frame.h"

#include <memory>
#include <string>

namespace hermes::velodynelogger {

/// A UDP port from which many datagrams are taken at once, each with the kernel's stamp.
class UdpSocket {
public:
    UdpSocket();
    ~UdpSocket();

    /// As UdpReceiver::start().
    Outcome<void> open(const std::string &address, std::uint16_t port, int bufferBytes);
    void close();

    /// Takes what waits, up to a batch. False when the socket failed; errno says why.
    bool receive();
    std::size_t count() const { return count_; } ///< datagrams of the last receive()
    const Datagram &datagram(std::size_t i) const;
    bool mayHaveMore() const { return full_; } ///< the last receive() was a whole batch
    std::size_t cut() const { return cut_; }   ///< and those too long for a sensor's, which are left out
    /// Dropped by the kernel, as far as it told in the last receive(): it tells with the next datagram.
    std::uint32_t drops() const { return drops_; }

    int descriptor() const { return socket_; }
    std::uint16_t port() const { return port_; }
    int bufferBytes() const { return bufferBytes_; } ///< granted

private:
    struct Batch;

    std::string failed(const std::string &what);
    void setOptions(int bufferBytes);

    std::unique_ptr<Batch> batch_;
    int socket_ = -1;
    std::uint16_t port_ = 0;
    int bufferBytes_ = 0;
    std::size_t count_ = 0;
    std::size_t cut_ = 0;
    bool full_ = false;
    std::uint32_t drops_ = 0;
    std::uint32_t allDrops_ = 0; ///< as the kernel counts; may wrap
};

} // namespace hermes::velodynelogger
