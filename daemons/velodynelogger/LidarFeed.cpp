#include "daemons/velodynelogger/LidarFeed.h"

namespace hermes {

LidarFeed::LidarFeed(Recorder &recorder, Notify turnReady)
    : recorder_(recorder)
    , turnReady_(std::move(turnReady))
    , receiver_([this](const Datagram &datagram) { handle(datagram); })
    , player_([this](const Datagram &datagram) { handle(datagram); },
              [this](const std::string &error) {
                  {
                      const std::lock_guard<std::mutex> lock(decoderMutex_);
                      assembler_->finish();
                  }
                  ended_(error);
              }) {}

LidarFeed::~LidarFeed() {
    close();
}

std::string LidarFeed::openLive(const std::string &address, std::uint16_t port, int bufferBytes,
                                const Options &options) {
    close();
    lossless_ = false;
    begin(options);
    return receiver_.start(address, port, bufferBytes);
}

std::string LidarFeed::openPcap(const std::string &path, double speed, const Options &options, Ended ended) {
    close();
    ended_ = std::move(ended);
    lossless_ = speed == 0;
    begin(options);
    return player_.start(path, speed);
}

void LidarFeed::begin(const Options &options) {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    options_ = options;
    velodyne::TurnAssembler::Options ring;
    ring.laser = options.laser;
    ring.model = options.model;
    ring.returns = options.returns;
    ring.stampOffset_ns = options.stampOffset_ns;
    assembler_ = std::make_unique<velodyne::TurnAssembler>(
        ring, [this](const velodyne::Turn &turn) { enqueue(turn); });
    counts_ = Counts();
    const std::lock_guard<std::mutex> queueLock(queueMutex_);
    closing_ = false;
}

void LidarFeed::close() {
    {
        const std::lock_guard<std::mutex> lock(queueMutex_);
        closing_ = true; // a player that waits for room must end
    }
    taken_.notify_all();
    receiver_.stop();
    player_.stop();
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    if (assembler_)
        assembler_->finish();
    cloudAssembler_.reset();
}

void LidarFeed::handle(const Datagram &datagram) {
    recorder_.push(datagram, lossless_);
    if (lossless_) { // before the decoder is locked, so that counts() answers meanwhile
        std::unique_lock<std::mutex> lock(queueMutex_);
        taken_.wait(lock, [this] { return turns_.size() < turnCapacity || closing_; });
    }
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    decode(datagram);
}

void LidarFeed::decode(const Datagram &datagram) {
    if (datagram.size == velodyne::positionPacketSize) {
        ++counts_.position;
        return;
    }
    if (datagram.size != velodyne::packetSize && datagram.destinationPort != options_.dataPort) {
        ++counts_.other;
        return;
    }
    assembler_->feed(datagram.payload, datagram.size, datagram.stamp_ns);
    if (cloudAssembler_)
        cloudAssembler_->feed(datagram.payload, datagram.size, datagram.stamp_ns);
    if (cloudAssembler_ && !cloudSink_) // delivered
        cloudAssembler_.reset();
}

void LidarFeed::enqueue(const velodyne::Turn &turn) {
    ++counts_.turns;
    auto copy = std::make_shared<velodyne::Turn>(turn);
    {
        const std::lock_guard<std::mutex> lock(queueMutex_);
        if (turns_.size() >= turnCapacity && !lossless_) {
            ++counts_.turnsDropped;
            return;
        }
        turns_.push_back(std::move(copy));
    }
    turnReady_();
}

LidarFeed::Turn LidarFeed::takeTurn() {
    Turn turn;
    {
        const std::lock_guard<std::mutex> lock(queueMutex_);
        if (turns_.empty())
            return turn;
        turn = std::move(turns_.front());
        turns_.pop_front();
    }
    taken_.notify_all();
    return turn;
}

void LidarFeed::captureCloud(std::function<void(const velodyne::Turn &)> function) {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    cloudSink_ = std::move(function);
    velodyne::TurnAssembler::Options all;
    all.laser = velodyne::PacketDecoder::allLasers;
    all.returns = options_.returns;
    all.model = options_.model;
    all.stampOffset_ns = options_.stampOffset_ns;
    cloudAssembler_ = std::make_unique<velodyne::TurnAssembler>(all, [this](const velodyne::Turn &turn) {
        if (turn.partial || !cloudSink_)
            return;
        cloudSink_(turn);
        cloudSink_ = nullptr;
    });
}

LidarFeed::Counts LidarFeed::counts() const {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    Counts counts = counts_;
    if (assembler_) {
        counts.packets = assembler_->counts();
        counts.rpm = assembler_->rpm();
    }
    counts.udp = receiver_.counts();
    return counts;
}

} // namespace hermes
