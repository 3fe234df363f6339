#pragma once

#include "common/capture/PcapReader.h"
#include "daemons/velodynelogger/PlayTime.h"

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace hermes {

/// Reads a capture through in a thread of its own, to tell how long it plays and where to begin to read for a
/// time. What is damaged ends it: the length is that of what can be played.
class PcapIndex {
public:
    /// A place in the file and the time of the record before it.
    struct Mark {
        PlayTime before;
        PcapReader::Place place;
    };

    ~PcapIndex() { stop(); }

    void start(const std::string &path);
    void stop();

    /// Nothing as long as the file is being read.
    std::optional<std::int64_t> duration_ns() const;
    /// The last place known that lies before this time.
    Mark before(std::int64_t time_ns) const;

private:
    void run(PcapReader &reader);

    std::thread thread_;
    std::atomic<bool> stopping_{false};
    mutable std::mutex mutex_; // guards what follows
    std::vector<Mark> marks_;
    std::optional<std::int64_t> duration_ns_;
};

} // namespace hermes
