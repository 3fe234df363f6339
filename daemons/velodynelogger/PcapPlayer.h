#pragma once

#include "common/recording/PlayClock.h"
#include "daemons/velodynelogger/PcapIndex.h"

#include <condition_variable>
#include <functional>

namespace hermes {

/// Plays the datagrams of capture files, one after the other, in a thread of its own, at the pace at which
/// they were received or any other.
class PcapPlayer {
public:
    struct Options {
        double speed = 1; ///< 1 is real time, 0 as fast as the sink takes it
        bool loop = false;
        bool paused = false; ///< from the beginning
        PlayTime begin{};    ///< when the first datagram is played, and what is a jump of the clock
    };
    struct Status {
        double position_s = 0;            ///< after the beginning, clock jumps left out
        std::optional<double> duration_s; ///< nothing until the files have been read through
        bool paused = false;
        std::uint64_t loops = 0; ///< how often it began anew
    };
    /// Called in the playing thread; the payload is valid during the call. May block: playing waits.
    using Sink = std::function<void(const Datagram &)>;
    /// Called in the playing thread: the next datagram does not follow the last one, after a seek or at the
    /// beginning of a loop.
    using Jump = std::function<void()>;
    /// Called in the playing thread when the last file has come to its end, or with the error that ended it
    /// before. Not called after stop().
    using End = std::function<void(const std::string &error)>;

    PcapPlayer(Sink sink, Jump jump, End end);
    ~PcapPlayer();

    /// An empty string on success, else what failed.
    std::string start(const std::vector<std::string> &paths, const Options &options);
    void stop();

    /// Goes on at the first datagram at or after this time; beyond the end is the end.
    void seek(double time_s);
    void setPaused(bool paused);
    Status status() const;

private:
    void run();
    bool play(const Datagram &datagram);
    bool goTo(std::int64_t time_ns);
    bool rewind(const PcapIndex::Mark &mark);

    Sink sink_;
    Jump jump_;
    End end_;
    PcapIndex index_;
    Options options_;

    // Of the thread while it runs.
    PcapSequence reader_;
    PlayTime time_;
    bool atTarget_ = false; ///< the datagram that a seek ended at is yet to be played
    Datagram target_;       ///< that datagram
    PlayClock clock_;

    std::thread thread_;
    mutable std::mutex mutex_; // guards what follows
    std::condition_variable wake_;
    bool stopping_ = false;
    bool paused_ = false;
    std::optional<std::int64_t> seek_ns_;
    std::int64_t position_ns_ = 0;
    std::uint64_t loops_ = 0;
};

} // namespace hermes
