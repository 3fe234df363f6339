#pragma once

#include "common/capture/Datagram.h"

#include <atomic>
#include <functional>
#include <string>
#include <thread>

namespace hermes {

/// Receives the datagrams of a UDP port in a thread of its own, stamped by the kernel, and counts those that
/// the kernel had to drop.
class UdpReceiver {
public:
    /// Called in the receiving thread; the payload is valid during the call.
    using Sink = std::function<void(const Datagram &)>;
    struct Counts {
        std::uint64_t received = 0;
        std::uint64_t kernelDrops = 0; ///< the socket's buffer was full
        std::uint64_t tooLong = 0;     ///< longer than any packet of the sensor, cut off: not delivered
        int bufferBytes = 0;           ///< what the system granted
    };

    explicit UdpReceiver(Sink sink);
    ~UdpReceiver();

    /// address is a local IPv4 address, 0.0.0.0 for all; port 0 takes any free one. An empty string on
    /// success, else what failed. bufferBytes asks the system for that much room.
    std::string start(const std::string &address, std::uint16_t port, int bufferBytes);
    void stop();

    bool isRunning() const { return thread_.joinable(); }
    std::uint16_t port() const { return port_; } ///< the one bound
    Counts counts() const;
    /// Why receiving ended by itself, or an empty string.
    std::string error() const { return failed_ ? error_ : std::string(); }

private:
    std::string fail(const std::string &what);
    void setOptions(int bufferBytes);
    void run();
    int receiveBatch();

    Sink sink_;
    int socket_ = -1;
    int wake_ = -1; ///< an eventfd that ends the wait
    std::uint16_t port_ = 0;
    std::thread thread_;
    std::atomic<bool> failed_{false};
    std::string error_; ///< set before failed_
    std::atomic<std::uint64_t> received_{0};
    std::atomic<std::uint64_t> kernelDrops_{0};
    std::atomic<std::uint64_t> tooLong_{0};
    int bufferBytes_ = 0;
};

} // namespace hermes
