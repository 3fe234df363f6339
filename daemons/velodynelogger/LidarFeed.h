#pragma once

#include "common/capture/LidarStream.h"
#include "daemons/velodynelogger/LiveSource.h"
#include "daemons/velodynelogger/PcapPlayer.h"
#include "daemons/velodynelogger/TurnQueue.h"

namespace hermes::velodynelogger {

/// From the sensor or a capture file to turns: receives or plays datagrams, hands each to the recorder,
/// decodes them and keeps the finished turns until they are taken. Of one laser always, of all lasers only
/// while somebody wants them.
class LidarFeed {
public:
    struct Options {
        int laser = velodyne::PacketDecoder::levelLaser;
        velodyne::Model model = velodyne::Model::Blank; ///< Blank: as the packets say
        velodyne::Returns returns = velodyne::Returns::Strongest;
        bool verticalOffsets = true; ///< the lasers' own heights are added to z
        std::int64_t stampOffset_ns = 0;
        velodyne::ClockChoice clock = velodyne::ClockChoice::Gps;
        std::uint16_t dataPort = velodyne::dataPort; ///< see LidarStream
        std::uint16_t positionPort = 0;              ///< received live as well; 0: none
        std::optional<std::uint16_t> onlyPort{};     ///< only a sensor that sends to it is decoded
        std::optional<std::uint32_t> sender{};       ///< only the sensor with this address is
    };
    /// How turns of all lasers are thinned.
    struct Thinning {
        std::uint32_t maximumPoints = 8000; ///< about: the firings of a turn are thinned evenly
        std::uint32_t turnStep = 1;         ///< every n-th turn
    };
    struct Counts {
        velodyne::PacketCounts packets;
        LiveSource::Counts udp;
        velodyne::GpsReader::Counts gps;             ///< of position packets
        std::uint64_t other = 0;                     ///< nothing that could be read; see LidarStream
        std::uint64_t otherSensors = 0;              ///< data packets of sensors that are not decoded
        std::vector<SensorChoice::Sensor> sensors;   ///< that sent data packets, the decoded one among them
        std::optional<SensorChoice::Sensor> decoded; ///< of these; nothing before the first
        std::uint64_t turns = 0;                     ///< finished
        std::uint64_t turnsDropped = 0;              ///< finished, but nobody took them in time
        std::uint64_t cloudsDropped = 0;
        std::uint32_t beams = 0, beamsBack = 0; ///< of the last turn, all lasers; those with a return
        double blind_s = 0; ///< for so long nearly no beam has come back; 0 when some did in the last turn
        double rpm = 0;
        velodyne::StampSource clock = velodyne::StampSource::Sensor; ///< of the last turn
        std::int64_t clockBound_ns = 0;
        std::uint64_t clockSteps = 0;                 ///< see LidarStream
        const velodyne::SensorModel *model = nullptr; ///< null before the first packet
    };
    using Turn = TurnQueue::Turn;
    using Notify = std::function<void()>;
    using Ended = PcapPlayer::End;
    /// Gets the next complete turn of all lasers, or null when the source ended before.
    using Capture = std::function<void(const velodyne::Turn *turn)>;

    /// turnReady is called in another thread when a turn waits to be taken.
    LidarFeed(Recorder &recorder, Notify turnReady);
    ~LidarFeed();

    /// Whatever was open is closed first.
    Outcome<void> openLive(const std::string &address, std::uint16_t port, int bufferBytes,
                           const Options &options);
    /// ended is called in another thread when the captures have been played to their end, or to the error
    /// given.
    Outcome<void> openPcap(const std::vector<std::string> &paths, const Playback::Options &play,
                           const Options &options, Ended ended, const PlayTime &begin = {});
    /// Delivers the turns that were under way as partial ones.
    void close();

    /// The oldest turn of the one laser that waits, or null.
    Turn takeTurn() { return take(turns_); }
    /// Turns of all lasers, thinned, are made from now on; or no longer.
    void wantClouds(const std::optional<Thinning> &thinning);
    /// The oldest of them that waits, or null. Its number is that of the turn of the one laser.
    Turn takeCloud() { return take(clouds_); }
    /// The next complete turn of all lasers, all points of it; the function is called in another thread.
    void captureTurn(Capture function);
    /// Ends the captures that wait, with null.
    void cancelCaptures();

    PcapPlayer &player() { return player_; }
    const PcapPlayer &player() const { return player_; }
    Counts counts() const;
    velodyne::GpsReader::State gps() const;
    std::uint16_t port() const { return live_.port(); } ///< of live reception
    std::optional<std::string> receiveError() const { return live_.error(); }
    const std::optional<std::string> &positionError() const { return live_.positionError(); }

private:
    using Assembler = std::unique_ptr<velodyne::TurnAssembler>;

    void begin(const Options &options, bool replays);
    void finish();
    void jump();
    void play(const Datagram &datagram);
    void decode(const Datagram &datagram);
    Assembler makeAssembler(int laser, velodyne::TurnAssembler::Sink sink) const;
    void makeCloudAssembler();
    template <typename Function>
    void forAssemblers(Function function);
    void takeOver(const velodyne::Turn &turn);
    void takeOverCloud(const velodyne::Turn &turn);
    void deliver(const velodyne::Turn *turn);
    Turn finished(const velodyne::Turn &turn) const;
    Turn take(TurnQueue &queue);

    Recorder &recorder_;
    Notify turnReady_;
    Ended ended_;           ///< set before the player starts
    bool lossless_ = false; ///< the source waits rather than lose; set before it starts

    mutable std::mutex decoderMutex_; // guards what follows
    Options options_;
    bool replays_ = false;
    std::optional<Thinning> thinning_;
    LidarStream stream_;
    Assembler ring_;
    Assembler cloud_;   ///< while clouds are wanted
    Assembler capture_; ///< while a capture waits
    std::vector<Capture> captures_;
    Counts counts_;

    mutable std::mutex queueMutex_; // guards what follows
    std::condition_variable taken_;
    TurnQueue turns_{16}; // over a second
    TurnQueue clouds_{8};
    bool closing_ = false;

    LiveSource live_; // last: their threads end before what they use
    PcapPlayer player_;
};

} // namespace hermes::velodynelogger
