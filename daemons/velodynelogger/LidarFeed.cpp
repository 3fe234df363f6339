#include "daemons/velodynelogger/LidarFeed.h"

namespace hermes {

LidarFeed::LidarFeed(Recorder &recorder, Notify turnReady)
    : m_recorder(recorder)
    , m_turnReady(std::move(turnReady))
    , m_receiver([this](const Datagram &datagram) { handle(datagram); })
    , m_player([this](const Datagram &datagram) { handle(datagram); },
               [this](const std::string &error) {
                   {
                       const std::lock_guard<std::mutex> lock(m_decoderMutex);
                       m_assembler->finish();
                   }
                   m_ended(error);
               }) {}

LidarFeed::~LidarFeed() {
    close();
}

std::string LidarFeed::openLive(const std::string &address, std::uint16_t port, int bufferBytes,
                                const Options &options) {
    close();
    m_lossless = false;
    begin(options);
    return m_receiver.start(address, port, bufferBytes);
}

std::string LidarFeed::openPcap(const std::string &path, double speed, const Options &options, Ended ended) {
    close();
    m_ended = std::move(ended);
    m_lossless = speed == 0;
    begin(options);
    return m_player.start(path, speed);
}

void LidarFeed::begin(const Options &options) {
    const std::lock_guard<std::mutex> lock(m_decoderMutex);
    m_options = options;
    velodyne::TurnAssembler::Options ring;
    ring.laser = options.laser;
    ring.returns = options.returns;
    ring.stampOffset_ns = options.stampOffset_ns;
    m_assembler = std::make_unique<velodyne::TurnAssembler>(
        ring, [this](const velodyne::Turn &turn) { enqueue(turn); });
    m_counts = Counts();
    const std::lock_guard<std::mutex> queueLock(m_queueMutex);
    m_closing = false;
}

void LidarFeed::close() {
    {
        const std::lock_guard<std::mutex> lock(m_queueMutex);
        m_closing = true; // a player that waits for room must end
    }
    m_taken.notify_all();
    m_receiver.stop();
    m_player.stop();
    const std::lock_guard<std::mutex> lock(m_decoderMutex);
    if (m_assembler)
        m_assembler->finish();
    m_cloudAssembler.reset();
}

void LidarFeed::handle(const Datagram &datagram) {
    m_recorder.push(datagram, m_lossless);
    if (m_lossless) { // before the decoder is locked, so that counts() answers meanwhile
        std::unique_lock<std::mutex> lock(m_queueMutex);
        m_taken.wait(lock, [this] { return m_turns.size() < turnCapacity || m_closing; });
    }
    const std::lock_guard<std::mutex> lock(m_decoderMutex);
    decode(datagram);
}

void LidarFeed::decode(const Datagram &datagram) {
    if (datagram.size == velodyne::positionPacketSize) {
        ++m_counts.position;
        return;
    }
    if (datagram.size != velodyne::packetSize && datagram.destinationPort != m_options.dataPort) {
        ++m_counts.other;
        return;
    }
    m_assembler->feed(datagram.payload, datagram.size, datagram.stamp_ns);
    if (m_cloudAssembler)
        m_cloudAssembler->feed(datagram.payload, datagram.size, datagram.stamp_ns);
    if (m_cloudAssembler && !m_cloudSink) // delivered
        m_cloudAssembler.reset();
}

void LidarFeed::enqueue(const velodyne::Turn &turn) {
    ++m_counts.turns;
    auto copy = std::make_shared<velodyne::Turn>(turn);
    {
        const std::lock_guard<std::mutex> lock(m_queueMutex);
        if (m_turns.size() >= turnCapacity && !m_lossless) {
            ++m_counts.turnsDropped;
            return;
        }
        m_turns.push_back(std::move(copy));
    }
    m_turnReady();
}

LidarFeed::Turn LidarFeed::takeTurn() {
    Turn turn;
    {
        const std::lock_guard<std::mutex> lock(m_queueMutex);
        if (m_turns.empty())
            return turn;
        turn = std::move(m_turns.front());
        m_turns.pop_front();
    }
    m_taken.notify_all();
    return turn;
}

void LidarFeed::captureCloud(std::function<void(const velodyne::Turn &)> function) {
    const std::lock_guard<std::mutex> lock(m_decoderMutex);
    m_cloudSink = std::move(function);
    velodyne::TurnAssembler::Options all;
    all.laser = velodyne::PacketDecoder::allLasers;
    all.returns = m_options.returns;
    all.stampOffset_ns = m_options.stampOffset_ns;
    m_cloudAssembler = std::make_unique<velodyne::TurnAssembler>(all, [this](const velodyne::Turn &turn) {
        if (turn.partial || !m_cloudSink)
            return;
        m_cloudSink(turn);
        m_cloudSink = nullptr;
    });
}

LidarFeed::Counts LidarFeed::counts() const {
    const std::lock_guard<std::mutex> lock(m_decoderMutex);
    Counts counts = m_counts;
    if (m_assembler) {
        counts.packets = m_assembler->counts();
        counts.rpm = m_assembler->rpm();
    }
    counts.udp = m_receiver.counts();
    return counts;
}

} // namespace hermes
