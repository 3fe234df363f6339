#pragma once

#include "daemons/velodynelogger/UdpSocket.h"

#include <atomic>
#include <functional>
#include <thread>

namespace hermes::velodynelogger {

/// Receives the datagrams of a sensor's data port, and of its position port where one is given, in a thread
/// of its own, stamped by the kernel, and counts those that the kernel had to drop. Does not allocate for a
/// datagram.
class UdpReceiver {
public:
    struct Options {
        std::string address;            ///< local IPv4 address, 0.0.0.0 for all
        std::uint16_t port = 0;         ///< 0 takes any free one
        std::uint16_t positionPort = 0; ///< 0: none
        int bufferBytes = 0;            ///< the room that the system is asked for, for each port
    };
    struct Losses {
        std::uint64_t kernel = 0;  ///< the socket's buffer was full
        std::uint64_t tooLong = 0; ///< longer than any packet of the sensor, cut off: not delivered
    };
    struct Counts {
        std::uint64_t received = 0;
        std::uint64_t kernelDrops = 0;
        std::uint64_t tooLong = 0;
        int bufferBytes = 0; ///< what the system granted
    };
    /// What hears of everything, in the receiving thread. Payloads are valid during the call.
    struct Sink {
        std::function<void(const Datagram &)> datagram;
        std::function<void(const Losses &)> lost; ///< since the last time
        std::function<void()> pause;              ///< what waited has been delivered
    };

    explicit UdpReceiver(Sink sink);
    ~UdpReceiver();

    /// A position port that cannot be opened does not hold up the data: positionError() tells of it.
    Outcome<void> start(const Options &options);
    void stop();

    bool isRunning() const { return thread_.joinable(); }
    std::uint16_t port() const { return data_.port(); } ///< the one bound
    Counts counts() const;
    /// Why receiving ended by itself; nothing while it goes on.
    std::optional<std::string> error() const { return failed_ ? std::optional(error_) : std::nullopt; }
    const std::optional<std::string> &positionError() const { return positionError_; }

private:
    void run();
    bool receive();
    void deliver();

    Sink sink_;
    UdpSocket data_;
    UdpSocket position_;
    std::optional<std::string> positionError_;
    int wake_ = -1; ///< an eventfd that ends the wait
    std::thread thread_;
    std::atomic<bool> failed_{false};
    std::string error_; ///< set before failed_
    std::atomic<std::uint64_t> received_{0};
    std::atomic<std::uint64_t> kernelDrops_{0};
    std::atomic<std::uint64_t> tooLong_{0};
};

} // namespace hermes::velodynelogger
