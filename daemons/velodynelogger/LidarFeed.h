#pragma once

#include "daemons/velodynelogger/PcapPlayer.h"
#include "daemons/velodynelogger/Recorder.h"
#include "daemons/velodynelogger/UdpReceiver.h"
#include "protocol/velodyne/TurnAssembler.h"

#include <deque>

namespace hermes {

/// From the sensor or a capture file to turns: receives or plays datagrams, hands each to the recorder,
/// decodes them and keeps the finished turns until they are taken.
class LidarFeed {
public:
    struct Options {
        int laser = velodyne::PacketDecoder::levelLaser;
        velodyne::Model model = velodyne::Model::Blank; ///< Blank: as the packets say
        velodyne::Returns returns = velodyne::Returns::Strongest;
        std::int64_t stampOffset_ns = 0;
        std::uint16_t dataPort =
            velodyne::dataPort; ///< of other ports only datagrams of the right size are decoded
    };
    struct Counts {
        velodyne::PacketCounts packets;
        UdpReceiver::Counts udp;
        std::uint64_t position = 0;     ///< position packets: recorded, not decoded
        std::uint64_t other = 0;        ///< of another port and another size
        std::uint64_t turns = 0;        ///< finished
        std::uint64_t turnsDropped = 0; ///< finished, but nobody took them in time
        double rpm = 0;
    };
    using Turn = std::shared_ptr<const velodyne::Turn>;
    using Notify = std::function<void()>;
    using Ended = std::function<void(const std::string &error)>;

    /// turnReady is called in another thread when a turn waits to be taken.
    LidarFeed(Recorder &recorder, Notify turnReady);
    ~LidarFeed();

    /// An empty string on success, else what failed. Whatever was open is closed first.
    std::string openLive(const std::string &address, std::uint16_t port, int bufferBytes,
                         const Options &options);
    /// ended is called in another thread when the capture has been played to its end, or to the error given.
    std::string openPcap(const std::string &path, double speed, const Options &options, Ended ended);
    /// Delivers the turn that was under way as a partial one.
    void close();

    /// The oldest turn that waits, or null.
    Turn takeTurn();
    /// The next complete turn of all lasers goes to the function, in another thread.
    void captureCloud(std::function<void(const velodyne::Turn &)> function);
    Counts counts() const;
    std::uint16_t port() const { return receiver_.port(); } ///< of live reception
    std::string receiveError() const { return receiver_.error(); }

private:
    void begin(const Options &options);
    void handle(const Datagram &datagram);
    void decode(const Datagram &datagram);
    void enqueue(const velodyne::Turn &turn);

    static constexpr std::size_t turnCapacity = 16; // over a second

    Recorder &recorder_;
    Notify turnReady_;
    Ended ended_;           ///< set before the player starts
    bool lossless_ = false; ///< the source waits rather than lose; set before it starts

    mutable std::mutex decoderMutex_; // guards what follows
    Options options_;
    std::unique_ptr<velodyne::TurnAssembler> assembler_;
    std::unique_ptr<velodyne::TurnAssembler> cloudAssembler_;
    std::function<void(const velodyne::Turn &)> cloudSink_;
    Counts counts_;

    std::mutex queueMutex_; // guards what follows
    std::condition_variable taken_;
    std::deque<Turn> turns_;
    bool closing_ = false;

    UdpReceiver receiver_; // last: their threads end before what they use
    PcapPlayer player_;
};

} // namespace hermes
