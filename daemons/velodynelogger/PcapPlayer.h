#pragma once

#include "common/recording/Playback.h"
#include "daemons/velodynelogger/PcapIndex.h"

#include <functional>

namespace hermes::velodynelogger {

/// Plays the datagrams of capture files, one after the other, in a thread of its own, at the pace at which
/// they were received or any other.
class PcapPlayer {
public:
    /// Called in the playing thread; the payload is valid during the call. May block: playing waits.
    using Sink = std::function<void(const Datagram &)>;
    /// Called in the playing thread: the next datagram does not follow the last one, after a seek or at the
    /// beginning of a loop.
    using Jump = std::function<void()>;
    /// Called in the playing thread when the last file has come to its end, or with the error that ended it
    /// before. Not called after stop().
    using End = std::function<void(const Outcome<void> &played)>;

    PcapPlayer(Sink sink, Jump jump, End end);
    ~PcapPlayer();

    /// At speed 0 as fast as the sink takes it. begin: when the
    /// first datagram is played, and what is a jump of the clock.
    Outcome<void> start(const std::vector<std::string> &paths, const Playback::Options &options,
                        const PlayTime &begin = {});
    void stop();

    /// A seek goes on at the first datagram at or after its time; beyond the end is the end.
    Playback &playback() { return playback_; }
    /// Clock jumps left out; nothing until the files have been read through.
    std::optional<double> duration_s() const;
    /// What the files gave, once End was called.
    const PcapReader::Counts &counts() const { return counts_; }

private:
    void run();
    bool play(const Datagram &datagram);
    bool goTo(std::int64_t time_ns);
    bool rewind(const PcapIndex::Mark &mark);

    Sink sink_;
    Jump jump_;
    End end_;
    PcapIndex index_;
    PlayTime begin_;

    // Of the thread while it runs.
    PcapSequence reader_;
    PlayTime time_;
    PcapReader::Counts counts_;
    bool atTarget_ = false; ///< the datagram that a seek ended at is yet to be played
    Datagram target_;       ///< that datagram

    Playback playback_;
};

} // namespace hermes::velodynelogger
