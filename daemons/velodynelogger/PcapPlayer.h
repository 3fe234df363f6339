#pragma once

#include "common/capture/PcapReader.h"

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace hermes {

/// Plays the datagrams of a capture file in a thread of its own, at the pace at which they were received or
/// any other.
class PcapPlayer {
public:
    /// Called in the playing thread; the payload is valid during the call. May block: playing waits.
    using Sink = std::function<void(const Datagram &)>;
    /// Called in the playing thread when the file has come to its end, or with the error that ended it
    /// before. Not called after stop().
    using End = std::function<void(const std::string &error)>;

    PcapPlayer(Sink sink, End end);
    ~PcapPlayer();

    /// speed 1 is real time, 0 as fast as the sink takes it. An empty string on success, else what failed.
    std::string start(const std::string &path, double speed);
    void stop();

    bool isRunning() const { return thread_.joinable(); }
    std::uint64_t played() const;

private:
    void run();
    bool waitUntil(std::chrono::steady_clock::time_point due);

    Sink sink_;
    End end_;
    PcapReader reader_; ///< of the thread while it runs
    double speed_ = 1;
    std::thread thread_;
    mutable std::mutex mutex_; // guards what follows
    std::condition_variable wake_;
    bool stopping_ = false;
    std::uint64_t played_ = 0;
};

} // namespace hermes
