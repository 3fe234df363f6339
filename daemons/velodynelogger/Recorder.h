#pragma once

#include "common/capture/PcapWriter.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace hermes {

/// Writes datagrams to a capture file in a thread of its own, so that a slow disk does not hold up receiving.
/// What does not fit the bounded queue is dropped and counted.
class Recorder {
public:
    struct Status {
        bool recording = false;
        std::string path;          ///< of this recording or the last
        std::uint64_t packets = 0; ///< written or about to be
        std::uint64_t bytes = 0;   ///< of the file
        std::uint64_t dropped = 0; ///< the queue was full, or the disk failed
        std::string error;         ///< of the disk; it ended the recording
    };

    /// capacity: bytes of payload that may wait for the disk.
    explicit Recorder(std::size_t capacity = 16 * 1024 * 1024);
    ~Recorder();

    /// Fails on an existing file. An empty string on success, else what failed.
    std::string start(const std::string &path);
    /// Writes what waits and closes the file. An empty string on success, else what failed.
    std::string stop();
    /// Takes a copy; does nothing unless recording. wait: rather wait for the disk than drop. Any thread.
    void push(const Datagram &datagram, bool wait);

    bool isRecording() const;
    Status status() const;

private:
    struct Batch {
        std::vector<Datagram> datagrams; ///< payload not set; in the order of bytes
        std::vector<std::uint8_t> bytes;
        void clear();
    };
    void run();
    bool write(const Batch &batch);

    const std::size_t capacity_;
    std::thread thread_;
    PcapWriter writer_;        ///< of the thread while it runs
    mutable std::mutex mutex_; // guards what follows
    std::condition_variable filled_;
    std::condition_variable emptied_;
    bool stopping_ = false;
    Batch queue_;
    std::uint64_t accepted_ = 0; ///< of this recording
    Status status_;
};

} // namespace hermes
