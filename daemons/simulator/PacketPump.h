#pragma once

#include "common/Outcome.h"
#include "daemons/simulator/LidarModel.h"
#include "daemons/simulator/Simulation.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

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

/// Runs a simulation in real time in a thread of its own and sends its packets over UDP, each when it is due,
/// and one with the position after every 14th.
/// A thread that was held up catches up a few packets at a time, so that receivers see no burst; after a
/// stall of seconds the missed packets are left out and counted.
class PacketPump {
public:
    struct Counts {
        std::uint64_t sent = 0;
        std::uint64_t positions = 0;  ///< position packets sent
        std::uint64_t swallowed = 0;  ///< by a fault that was asked for
        std::uint64_t skipped = 0;    ///< not made, because the machine stalled
        std::uint64_t sendErrors = 0; ///< the system refused to send
        double worstLag_s = 0;        ///< how late a packet was sent
    };
    using TruthSink = std::function<void(const Simulation::Truth &)>;

    using LineSink = std::function<void(const std::string &)>;

    /// All are called in the pump's thread: truth each 20 ms of simulated time, the others with what GPS
    /// receiver and scanner send.
    explicit PacketPump(
        TruthSink truth, LineSink gps = [](const std::string &) {},
        LineSink scanner = [](const std::string &) {});
    ~PacketPump();

    /// As of the VLP-16 and VLS-128; the manual of the HDL-32E does not tell.
    static constexpr int packetsPerPosition = 14;
    /// Times of packets after which the scanner's bytes go on: 2.2 ms.
    static constexpr int packetsPerScannerBytes = 4;

    /// Opens the sockets and starts. host is an IPv4 address; port 0: the lidar is off; positionPort 0: no
    /// position packets.
    Outcome<void> start(const World &world, const Simulation::Options &options, const std::string &host,
                        std::uint16_t port, std::uint16_t positionPort = 0);
    void stop();

    /// Runs the function between two packets. Does nothing unless the pump is running.
    void with(const std::function<void(Simulation &)> &function);
    /// Loses what the scanner has sent and has not gone on yet.
    void dropScannerBytes();
    void setFault(const LidarFault &fault);
    LidarFault fault() const;
    Counts counts() const;

private:
    void run();
    void step();
    void send(UdpSender &sender, const std::uint8_t *bytes, std::size_t size, std::uint64_t &sent);

    TruthSink truth_;
    LineSink gps_, scanner_;
    UdpSender data_, position_;
    std::thread thread_;
    std::atomic<bool> running_{false};

    mutable std::mutex mutex_; // guards what follows
    Simulation simulation_;
    LidarFault fault_;
    std::minstd_rand random_;
    Counts counts_;
    std::int64_t nextTruth_ns_ = 0;
    int sincePosition_ = 0, sinceScanner_ = 0; ///< packets
    std::string scannerBytes_;
};

} // namespace hermes::simulator
