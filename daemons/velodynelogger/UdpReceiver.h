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

    bool isRunning() const { return m_thread.joinable(); }
    std::uint16_t port() const { return m_port; } ///< the one bound
    Counts counts() const;
    /// Why receiving ended by itself, or an empty string.
    std::string error() const { return m_failed ? m_error : std::string(); }

private:
    std::string fail(const std::string &what);
    void setOptions(int bufferBytes);
    void run();
    int receiveBatch();

    Sink m_sink;
    int m_socket = -1;
    int m_wake = -1; ///< an eventfd that ends the wait
    std::uint16_t m_port = 0;
    std::thread m_thread;
    std::atomic<bool> m_failed{false};
    std::string m_error; ///< set before m_failed
    std::atomic<std::uint64_t> m_received{0};
    std::atomic<std::uint64_t> m_kernelDrops{0};
    std::atomic<std::uint64_t> m_tooLong{0};
    int m_bufferBytes = 0;
};

} // namespace hermes
