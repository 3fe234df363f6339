#pragma once

#include "daemons/velodynelogger/PcapSequence.h"
#include "daemons/velodynelogger/PlayTime.h"

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace hermes::velodynelogger {

/// Reads captures through in a thread of its own, to tell how long it plays and where to begin to read for a
/// time. What is damaged ends it: the length is that of what can be played.
class PcapIndex {
public:
    /// A place in the files and the time of the record before it.
    struct Mark {
        PlayTime before;
        PcapSequence::Place place;
    };

    ~PcapIndex() { stop(); }

    /// begin: the time before the first record.
    void start(const std::vector<std::string> &paths, const PlayTime &begin);
    void stop();

    /// Nothing as long as the file is being read.
    std::optional<std::int64_t> duration_ns() const;
    /// The last place known that lies before this time.
    Mark before(std::int64_t time_ns) const;

private:
    void run(PcapSequence &reader, PlayTime time);

    std::thread thread_;
    std::atomic<bool> stopping_{false};
    mutable std::mutex mutex_; // guards what follows
    Mark begin_;
    std::vector<Mark> marks_;
    std::optional<std::int64_t> duration_ns_;
};

} // namespace hermes::velodynelogger
