#pragma once

#include "daemons/velodynelogger/DatagramRing.h"
#include "daemons/velodynelogger/Recorder.h"
#include "daemons/velodynelogger/UdpReceiver.h"

namespace hermes::velodynelogger {

/// Live packets: one thread receives and hands them to the recorder, another decodes. However slow decoding
/// is, the recording gets everything; what the decoder cannot take is dropped and counted.
class LiveSource {
public:
    /// Called in the decoding thread; the payload is valid during the call.
    using Sink = std::function<void(const Datagram &)>;
    struct Counts : UdpReceiver::Counts {
        std::uint64_t decoderDrops = 0; ///< recorded, but not decoded: the decoder was too slow
    };

    LiveSource(Recorder &recorder, Sink decode);
    ~LiveSource();

    /// As UdpReceiver.
    Outcome<void> start(const UdpReceiver::Options &options);
    /// What was received has been decoded when it returns.
    void stop();

    std::uint16_t port() const { return receiver_.port(); }
    Counts counts() const;
    std::optional<std::string> error() const { return receiver_.error(); }
    const std::optional<std::string> &positionError() const { return receiver_.positionError(); }

private:
    void take(const Datagram &datagram);
    void run();

    static constexpr std::size_t waitingBytes = 2 * 1024 * 1024; // almost a second

    Recorder &recorder_;
    Sink decode_;
    DatagramRing ring_{waitingBytes};
    std::atomic<std::uint64_t> drops_{0};
    std::atomic<bool> stopping_{false};
    UdpReceiver receiver_;
    std::thread thread_;
};

} // namespace hermes::velodynelogger
