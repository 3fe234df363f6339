#pragma once

#include "daemons/simulator/LidarFault.h"
#include "daemons/simulator/Simulation.h"

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace hermes {

/// Runs a simulation in real time in a thread of its own and sends its packets over UDP, each when it is due.
/// A thread that was held up catches up a few packets at a time, so that receivers see no burst; after a
/// stall of seconds the missed packets are left out and counted.
class PacketPump {
public:
    struct Counts {
        std::uint64_t sent = 0;
        std::uint64_t swallowed = 0;  ///< by a fault that was asked for
        std::uint64_t skipped = 0;    ///< not made, because the machine stalled
        std::uint64_t sendErrors = 0; ///< the system refused to send
        double worstLag_s = 0;        ///< how late a packet was sent
    };
    using TruthSink = std::function<void(const Simulation::Truth &)>;

    /// truth is called in the pump's thread, each 20 ms of simulated time.
    explicit PacketPump(TruthSink truth);
    ~PacketPump();

    /// Opens the socket and starts. host is an IPv4 address; an empty string on success, else what failed.
    std::string start(const World &world, const Simulation::Options &options, const std::string &host,
                      std::uint16_t port);
    void stop();

    /// Runs the function between two packets. Does nothing unless the pump is running.
    void with(const std::function<void(Simulation &)> &function);
    void setFault(const LidarFault &fault);
    LidarFault fault() const;
    Counts counts() const;

private:
    void run();
    void step();

    TruthSink truth_;
    int socket_ = -1;
    std::thread thread_;
    std::atomic<bool> running_{false};

    mutable std::mutex mutex_; // guards what follows
    Simulation simulation_;
    LidarFault fault_;
    std::minstd_rand random_;
    Counts counts_;
    std::int64_t nextTruth_ns_ = 0;
};

} // namespace hermes
