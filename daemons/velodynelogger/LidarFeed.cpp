#include "daemons/velodynelogger/LidarFeed.h"

#include <algorithm>

namespace hermes::velodynelogger {

namespace {

/// So long may a sensor be silent before another is decoded.
constexpr std::int64_t streamTimeout_ns = 1000000000;

/// Of the beams of a turn. The floor alone returns some of every sensor that stands upright and is not
/// covered.
constexpr double leastBack = 0.01;

/// Every how many firings are taken so that a turn of so many has no more points than are wanted.
std::uint32_t firingStep(const velodyne::SensorModel &model, std::int64_t firings, std::uint32_t wanted) {
    const std::int64_t taken = std::max<std::int64_t>(1, wanted / model.lasers);
    return std::uint32_t(std::max<std::int64_t>(1, (firings + taken - 1) / taken));
}

} // namespace

LidarFeed::LidarFeed(Recorder &recorder, Notify turnReady)
    : recorder_(recorder)
    , turnReady_(std::move(turnReady))
    , live_(recorder, [this](const Datagram &datagram) { decode(datagram); })
    , player_([this](const Datagram &datagram) { play(datagram); }, [this] { jump(); },
              [this](const Outcome<void> &played) {
                  finish();
                  ended_(played);
              }) {}

LidarFeed::~LidarFeed() {
    close();
}

Outcome<void> LidarFeed::openLive(const std::string &address, std::uint16_t port, int bufferBytes,
                                  const Options &options) {
    close();
    lossless_ = false;
    begin(options, false);
    return live_.start({address, port, options.positionPort, bufferBytes});
}

Outcome<void> LidarFeed::openPcap(const std::vector<std::string> &paths, const Playback::Options &play,
                                  const Options &options, Ended ended, const PlayTime &begin) {
    close();
    ended_ = std::move(ended);
    lossless_ = play.speed == 0;
    this->begin(options, true);
    return player_.start(paths, play, begin);
}

void LidarFeed::begin(const Options &options, bool replays) {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    options_ = options;
    replays_ = replays;
    LidarStream::Options stream;
    stream.sensor = {options.onlyPort, options.sender, streamTimeout_ns};
    stream.model = options.model;
    stream.dataPort = options.dataPort;
    stream.clock = options.clock;
    stream_ = LidarStream(stream);
    ring_.reset(); // numbers begin anew
    ring_ = makeAssembler(options.laser, [this](const velodyne::Turn &turn) { takeOver(turn); });
    cloud_.reset();
    if (thinning_)
        makeCloudAssembler();
    counts_ = Counts();
    const std::lock_guard<std::mutex> queueLock(queueMutex_);
    turns_.resetCount();
    clouds_.resetCount();
    closing_ = false;
}

void LidarFeed::close() {
    {
        const std::lock_guard<std::mutex> lock(queueMutex_);
        closing_ = true; // a player that waits for room must end
    }
    taken_.notify_all();
    live_.stop();
    player_.stop();
    finish();
}

void LidarFeed::finish() {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    forAssemblers([](velodyne::TurnAssembler &assembler) { assembler.finish(); });
    deliver(nullptr);
    capture_.reset();
}

void LidarFeed::jump() {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    stream_.jump();
    forAssemblers([](velodyne::TurnAssembler &assembler) { assembler.jump(); });
}

LidarFeed::Assembler LidarFeed::makeAssembler(int laser, velodyne::TurnAssembler::Sink sink) const {
    velodyne::TurnAssembler::Options options;
    options.laser = laser;
    options.model = options_.model;
    options.returns = options_.returns;
    options.verticalOffsets = options_.verticalOffsets;
    options.stampOffset_ns = options_.stampOffset_ns;
    options.firstNumber = ring_ ? ring_->turnNumber() : 0;
    auto assembler = std::make_unique<velodyne::TurnAssembler>(options, std::move(sink));
    assembler->follow(stream_.gps().state().utc_ns);
    return assembler;
}

void LidarFeed::makeCloudAssembler() {
    cloud_ = makeAssembler(velodyne::PacketDecoder::allLasers,
                           [this](const velodyne::Turn &turn) { takeOverCloud(turn); });
    const velodyne::SensorModel *model =
        ring_->model() ? ring_->model() : velodyne::findSensorModel(options_.model);
    const double turnsPerSecond = ring_->rpm() > 0 ? ring_->rpm() / 60 : 10;
    cloud_->setFiringStep(firingStep(*model, std::int64_t(double(model->firingRate()) / turnsPerSecond),
                                     thinning_->maximumPoints));
}

template <typename Function>
void LidarFeed::forAssemblers(Function function) {
    for (const Assembler *assembler : {&ring_, &cloud_, &capture_})
        if (*assembler)
            function(**assembler);
}

void LidarFeed::play(const Datagram &datagram) {
    recorder_.push(datagram, lossless_);
    if (lossless_) { // before the decoder is locked, so that counts() answers meanwhile
        std::unique_lock<std::mutex> lock(queueMutex_);
        taken_.wait(lock, [this] { return (!turns_.isFull() && !clouds_.isFull()) || closing_; });
    }
    decode(datagram);
}

void LidarFeed::decode(const Datagram &datagram) {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    stream_.take(datagram, {ring_.get(), cloud_.get(), capture_.get()});
    if (capture_ && captures_.empty()) // delivered
        capture_.reset();
}

void LidarFeed::takeOver(const velodyne::Turn &turn) {
    ++counts_.turns;
    counts_.clock = turn.clock;
    counts_.clockBound_ns = turn.clockBound_ns;
    counts_.beams = turn.beams;
    counts_.beamsBack = turn.beamsBack;
    const bool isBlind = turn.beamsBack < leastBack * turn.beams;
    counts_.blind_s = isBlind ? counts_.blind_s + double(turn.end_ns - turn.begin_ns) * 1e-9 : 0;
    const Turn copy = finished(turn);
    {
        const std::lock_guard<std::mutex> lock(queueMutex_);
        if (!turns_.push(copy, lossless_))
            return;
    }
    turnReady_();
}

void LidarFeed::takeOverCloud(const velodyne::Turn &turn) {
    if (!turn.partial)
        cloud_->setFiringStep(firingStep(*turn.model, turn.firings, thinning_->maximumPoints));
    if (turn.number % thinning_->turnStep != 0)
        return;
    const Turn copy = finished(turn);
    {
        const std::lock_guard<std::mutex> lock(queueMutex_);
        if (!clouds_.push(copy, lossless_))
            return;
    }
    turnReady_();
}

LidarFeed::Turn LidarFeed::finished(const velodyne::Turn &turn) const {
    return std::make_shared<FinishedTurn>(FinishedTurn{turn, replays_});
}

LidarFeed::Turn LidarFeed::take(TurnQueue &queue) {
    Turn turn;
    {
        const std::lock_guard<std::mutex> lock(queueMutex_);
        turn = queue.take();
    }
    if (turn)
        taken_.notify_all();
    return turn;
}

void LidarFeed::wantClouds(const std::optional<Thinning> &thinning) {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    thinning_ = thinning;
    if (!thinning)
        cloud_.reset();
    else if (!cloud_ && ring_)
        makeCloudAssembler();
    const std::lock_guard<std::mutex> queueLock(queueMutex_);
    if (!thinning)
        clouds_.clear();
    taken_.notify_all();
}

void LidarFeed::captureTurn(Capture function) {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    captures_.push_back(std::move(function));
    if (!capture_)
        capture_ = makeAssembler(velodyne::PacketDecoder::allLasers, [this](const velodyne::Turn &turn) {
            if (!turn.partial)
                deliver(&turn);
        });
}

void LidarFeed::cancelCaptures() {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    deliver(nullptr);
    capture_.reset();
}

void LidarFeed::deliver(const velodyne::Turn *turn) {
    for (const Capture &capture : captures_)
        capture(turn);
    captures_.clear();
}

LidarFeed::Counts LidarFeed::counts() const {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    Counts counts = counts_;
    if (ring_) {
        counts.packets = ring_->counts();
        counts.rpm = ring_->rpm();
        counts.model = ring_->model();
    }
    const SensorChoice &sensors = stream_.sensors();
    counts.sensors = sensors.sensors();
    if (sensors.taken())
        counts.decoded = *sensors.taken();
    counts.gps = stream_.gps().counts();
    counts.other = stream_.other();
    counts.otherSensors = stream_.otherSensors();
    counts.clockSteps = stream_.clockSteps();
    counts.udp = live_.counts();
    const std::lock_guard<std::mutex> queueLock(queueMutex_);
    counts.turnsDropped = turns_.dropped();
    counts.cloudsDropped = clouds_.dropped();
    return counts;
}

velodyne::GpsReader::State LidarFeed::gps() const {
    const std::lock_guard<std::mutex> lock(decoderMutex_);
    return stream_.gps().state();
}

} // namespace hermes::velodynelogger
