#include "common/recording/Playback.h"

#include <algorithm>
#include <utility>

namespace hermes {
namespace {

constexpr double longest_ns = 1e18; // 30 years

} // namespace

void Playback::start(const Options &options, std::function<void()> play) {
    stop();
    options_ = options;
    stopping_ = false;
    paused_ = options.paused;
    seek_ns_.reset();
    sought_ns_.reset();
    position_ns_ = 0;
    loops_ = 0;
    jump(0);
    thread_ = std::thread([this, play = std::move(play)] {
        waitToEnd(); // of nothing: it would not wait for any time
        play();
    });
}

void Playback::stop() {
    change([this] { stopping_ = true; });
    if (thread_.joinable())
        thread_.join();
}

void Playback::setPaused(bool paused) {
    change([&] { paused_ = paused; });
}

void Playback::seek(double time_s) {
    change([&] { seek_ns_ = position_ns_ = std::int64_t(time_s * 1e9); });
}

void Playback::setSpeed(double speed) {
    change([&] {
        hold();
        if (options_.speed <= 0) // nothing was waited for
            begin_ns_ = position_ns_;
        options_.speed = speed;
    });
}

void Playback::change(const std::function<void()> &what) {
    const std::lock_guard<std::mutex> lock(mutex_);
    what();
    wake_.notify_all();
}

Playback::Status Playback::status() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {double(position_ns_) * 1e-9, paused_, loops_};
}

Playback::Turn Playback::waitFor(std::int64_t time_ns) {
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
        if (stopping_)
            return Turn::End;
        if (seek_ns_)
            return Turn::Seek;
        if (isPreview(time_ns))
            return Turn::Due;
        if (paused_) {
            hold();
            wake_.wait(lock);
            continue;
        }
        sought_ns_.reset();
        since_ = since_.value_or(Clock::now());
        if (options_.speed <= 0 || Clock::now() >= due(time_ns))
            break;
        wake_.wait_until(lock, due(time_ns));
    }
    position_ns_ = time_ns;
    return Turn::Due;
}

Playback::Turn Playback::waitToEnd() {
    std::unique_lock<std::mutex> lock(mutex_);
    wake_.wait(lock, [this] { return !paused_ || stopping_ || seek_ns_; });
    return stopping_ ? Turn::End : seek_ns_ ? Turn::Seek : Turn::Due;
}

bool Playback::isPreview(std::int64_t time_ns) const {
    return paused_ && sought_ns_ && time_ns <= *sought_ns_ + preview_ns;
}

bool Playback::rest(std::chrono::milliseconds time) {
    std::unique_lock<std::mutex> lock(mutex_);
    return !wake_.wait_for(lock, time, [this] { return stopping_; });
}

std::int64_t Playback::takeSeek() {
    const std::lock_guard<std::mutex> lock(mutex_);
    sought_ns_ = std::exchange(seek_ns_, std::nullopt).value_or(position_ns_);
    return *sought_ns_;
}

bool Playback::isInterrupted() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return stopping_ || seek_ns_;
}

void Playback::jump(std::int64_t time_ns) {
    const std::lock_guard<std::mutex> lock(mutex_);
    begin_ns_ = time_ns;
    since_.reset();
}

void Playback::loop() {
    jump(0);
    const std::lock_guard<std::mutex> lock(mutex_);
    ++loops_;
}

/// The time stands still from here on.
void Playback::hold() {
    if (since_)
        begin_ns_ += std::int64_t(std::chrono::duration<double, std::nano>(Clock::now() - *since_).count() *
                                  options_.speed);
    since_.reset();
}

Playback::Clock::time_point Playback::due(std::int64_t time_ns) const {
    const double wait_ns = double(time_ns - begin_ns_) / options_.speed;
    return *since_ + std::chrono::nanoseconds(std::int64_t(std::min(wait_ns, longest_ns)));
}

} // namespace hermes
