#include "daemons/velodynelogger/PcapPlayer.h"

#include <utility>

namespace hermes {

PcapPlayer::PcapPlayer(Sink sink, Jump jump, End end)
    : sink_(std::move(sink))
    , jump_(std::move(jump))
    , end_(std::move(end)) {}

PcapPlayer::~PcapPlayer() {
    stop();
}

std::string PcapPlayer::start(const std::vector<std::string> &paths, const Options &options) {
    stop();
    if (!reader_.open(paths))
        return reader_.error();
    options_ = options;
    time_ = options.begin;
    atTarget_ = false;
    clock_.set(0, options.speed);
    stopping_ = false;
    paused_ = options.paused;
    seek_ns_.reset();
    position_ns_ = 0;
    loops_ = 0;
    index_.start(paths, options.begin);
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
    index_.stop();
    reader_.close();
}

void PcapPlayer::seek(double time_s) {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        seek_ns_ = std::int64_t(time_s * 1e9);
        position_ns_ = *seek_ns_;
    }
    wake_.notify_all();
}

void PcapPlayer::setPaused(bool paused) {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        paused_ = paused;
    }
    wake_.notify_all();
}

PcapPlayer::Status PcapPlayer::status() const {
    Status status;
    if (const auto duration_ns = index_.duration_ns())
        status.duration_s = double(*duration_ns) * 1e-9;
    const std::lock_guard<std::mutex> lock(mutex_);
    status.position_s = double(position_ns_) * 1e-9;
    status.paused = paused_;
    status.loops = loops_;
    return status;
}

void PcapPlayer::run() {
    bool played = false; // since the beginning of the file: an empty one is not looped
    for (;;) {
        Datagram datagram = target_;
        PcapReader::Next next = PcapReader::Next::Datagram;
        if (!std::exchange(atTarget_, false))
            next = reader_.next(datagram);
        if (next == PcapReader::Next::Datagram) {
            played = true;
            if (!play(datagram))
                return;
            continue;
        }
        const std::string error = next == PcapReader::Next::Failed ? reader_.error() : std::string();
        if (!options_.loop || !error.empty() || !played) {
            end_(error);
            return;
        }
        played = false;
        if (!rewind({options_.begin, {}}))
            return;
        clock_.set(0, options_.speed);
        const std::lock_guard<std::mutex> lock(mutex_);
        ++loops_;
    }
}

/// False when playing is at its end.
bool PcapPlayer::play(const Datagram &datagram) {
    const std::int64_t now_ns = time_.advance(datagram.stamp_ns);
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
        if (stopping_)
            return false;
        if (seek_ns_) {
            const std::int64_t target_ns = *std::exchange(seek_ns_, std::nullopt);
            lock.unlock();
            return goTo(target_ns);
        }
        if (paused_) {
            clock_.hold();
            wake_.wait(lock);
            continue;
        }
        if (options_.speed <= 0)
            break;
        clock_.run();
        const auto due = clock_.due(now_ns);
        if (PlayClock::Clock::now() >= due)
            break;
        wake_.wait_until(lock, due);
    }
    position_ns_ = now_ns;
    lock.unlock();
    sink_(datagram);
    return true;
}

bool PcapPlayer::goTo(std::int64_t time_ns) {
    PcapIndex::Mark mark = index_.before(time_ns);
    // Only what lies between here and there need be read.
    const bool ahead = time_ns > time_.now_ns() && mark.before.now_ns() <= time_.now_ns();
    if (ahead)
        jump_();
    else if (!rewind(mark))
        return false;
    clock_.set(time_ns, options_.speed);
    while (reader_.next(target_) == PcapReader::Next::Datagram) {
        PlayTime after = time_;
        if (after.advance(target_.stamp_ns) >= time_ns) {
            atTarget_ = true;
            break;
        }
        time_ = after;
        const std::lock_guard<std::mutex> lock(mutex_);
        if (stopping_)
            return false;
        if (seek_ns_) // and elsewhere already
            break;
    }
    return true; // at the end of the file, or where it is damaged, run() finds so
}

bool PcapPlayer::rewind(const PcapIndex::Mark &mark) {
    jump_();
    time_ = mark.before;
    const bool opened = reader_.seek(mark.place);
    if (!opened)
        end_(reader_.error());
    return opened;
}

} // namespace hermes
