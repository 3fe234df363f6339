#pragma once

#include "daemons/velodynelogger/DatagramRing.h"
#include "daemons/velodynelogger/PacketAccount.h"
#include "daemons/velodynelogger/PcapFiles.h"

#include <thread>

namespace hermes::velodynelogger {

/// Writes datagrams to capture files in a thread of its own, so that a slow disk does not hold up receiving.
/// What does not fit the bounded queue is dropped and counted. What was pushed is in the file, safe from the
/// end of this process, a few hundredths of a second later.
class Recorder : public RecordingWriter {
public:
    /// capacity: bytes that may wait for the disk.
    explicit Recorder(std::size_t capacity = 12 * 1024 * 1024);
    ~Recorder() override;

    bool goesOn() const override { return true; }
    Result<void> begin(const RecordingPlan &plan) override;
    void end() override;
    RecordingState state() const override;
    /// Cuts the capture files back to whole datagrams, and brings `files`, `bytes`, `counts`, `losses` and
    /// `end` of the sidecar up to what they hold. Reads only what the sidecar does not know.
    Result<void> repair(const RecordingPlan &plan, QJsonObject &sidecar) override;

    /// Takes a copy; does nothing unless recording. wait: rather wait for the disk than drop. From one thread
    /// at a time.
    void push(const Datagram &datagram, bool wait);
    /// What was lost before it could be pushed. Any thread.
    void noteLosses(std::uint64_t kernel, std::uint64_t tooLong);

    bool isRecording() const { return accepting_; }

private:
    /// Of a recording, together true at one moment.
    struct Progress {
        QJsonObject earlier; ///< sidecar of what was recorded before an interruption
        std::string path;
        std::vector<PcapFiles::File> files;
        PacketAccount::Counts counts;
        std::vector<std::uint8_t> position; ///< the last position packet
        std::optional<std::string> error;
    };

    void run();
    Outcome<void> writeWaiting(bool &more);
    void publish(const Outcome<void> &written);

    DatagramRing ring_;
    std::atomic<bool> accepting_{false};
    std::atomic<bool> pushing_{false};
    std::atomic<bool> stopping_{false};
    std::atomic<std::uint64_t> queueDrops_{0};
    std::atomic<std::uint64_t> kernelDrops_{0};
    std::atomic<std::uint64_t> tooLong_{0};
    std::atomic<bool> failed_{false};
    std::atomic<std::uint64_t> afterFailure_{0}; ///< packets, until end()
    std::thread thread_;
    PcapFiles files_;       ///< of the thread while it runs
    PacketAccount account_; ///< of the thread while it runs
    mutable std::mutex mutex_;
    Progress progress_; ///< guarded by the mutex
};

} // namespace hermes::velodynelogger
