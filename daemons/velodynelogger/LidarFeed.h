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
        int laser = velodyne::horizonLaser;
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
    std::uint16_t port() const { return m_receiver.port(); } ///< of live reception
    std::string receiveError() const { return m_receiver.error(); }

private:
    void begin(const Options &options);
    void handle(const Datagram &datagram);
    void decode(const Datagram &datagram);
    void enqueue(const velodyne::Turn &turn);

    static constexpr std::size_t turnCapacity = 16; // over a second

    Recorder &m_recorder;
    Notify m_turnReady;
    Ended m_ended;           ///< set before the player starts
    bool m_lossless = false; ///< the source waits rather than lose; set before it starts

    mutable std::mutex m_decoderMutex; // guards what follows
    Options m_options;
    std::unique_ptr<velodyne::TurnAssembler> m_assembler;
    std::unique_ptr<velodyne::TurnAssembler> m_cloudAssembler;
    std::function<void(const velodyne::Turn &)> m_cloudSink;
    Counts m_counts;

    std::mutex m_queueMutex; // guards what follows
    std::condition_variable m_taken;
    std::deque<Turn> m_turns;
    bool m_closing = false;

    UdpReceiver m_receiver; // last: their threads end before what they use
    PcapPlayer m_player;
};

} // namespace hermes
