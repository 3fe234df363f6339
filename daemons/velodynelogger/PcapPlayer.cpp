#include "daemons/velodynelogger/PcapPlayer.h"

namespace hermes {

PcapPlayer::PcapPlayer(Sink sink, End end)
    : sink_(std::move(sink))
    , end_(std::move(end)) {}

PcapPlayer::~PcapPlayer() {
    stop();
}

std::string PcapPlayer::start(const std::string &path, double speed) {
    stop();
    if (!reader_.open(path))
        return reader_.error();
    speed_ = speed;
    stopping_ = false;
    played_ = 0;
    thread_ = std::thread([this] { run(); });
    return {};
}

void PcapPlayer::stop() {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable())
        thread_.join();
    reader_.close();
}

std::uint64_t PcapPlayer::played() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return played_;
}

void PcapPlayer::run() {
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin = Clock::now();
    std::int64_t first_ns = 0;
    Datagram datagram;
    PcapReader::Next next;
    bool started = false;
    while ((next = reader_.next(datagram)) == PcapReader::Next::Datagram) {
        if (!started) {
            first_ns = datagram.stamp_ns;
            started = true;
        }
        const auto since = std::chrono::nanoseconds(
            speed_ > 0 ? std::int64_t(double(datagram.stamp_ns - first_ns) / speed_) : 0);
        if (!waitUntil(begin + since))
            return;
        sink_(datagram);
    }
    if (waitUntil(begin))
        end_(next == PcapReader::Next::Failed ? reader_.error() : std::string());
}

bool PcapPlayer::waitUntil(std::chrono::steady_clock::time_point due) {
    std::unique_lock<std::mutex> lock(mutex_);
    wake_.wait_until(lock, due, [this] { return stopping_; });
    played_ += stopping_ ? 0 : 1;
    return !stopping_;
}

} // namespace hermes
