#include "tests/support/NoisyLine.h"

#include "common/Time.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include <fcntl.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace hermes {

NoisyLine::NoisyLine(double bytesPerSecond)
    : byte_s_(1 / bytesPerSecond) {
    openEnd(0);
    openEnd(1);
    ways_[0] = {far_[0], far_[1], 0};
    ways_[1] = {far_[1], far_[0], 0};
    thread_ = std::thread([this] { run(); });
}

NoisyLine::~NoisyLine() {
    stop_ = true;
    thread_.join();
    for (const int fd : {far_[0], far_[1], near_[0], near_[1]})
        ::close(fd);
}

void NoisyLine::openEnd(std::size_t end) {
    char path[256];
    termios raw{};
    cfmakeraw(&raw);
    if (openpty(&far_[end], &near_[end], path, &raw, nullptr) != 0)
        throw std::runtime_error("no pseudo-terminal");
    fcntl(far_[end], F_SETFL, O_NONBLOCK);
    devices_[end] = QString::fromLocal8Bit(path);
}

void NoisyLine::setDamage(int oneIn, unsigned int seed) {
    seed_ = seed;
    oneIn_ = unsigned(oneIn);
    reseed_ = true;
}

void NoisyLine::run() {
    while (!stop_) {
        if (reseed_.exchange(false))
            random_.seed(seed_);
        for (Way &way : ways_)
            pass(way, monotonicNow());
        std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
}

void NoisyLine::pass(Way &way, double now) {
    char bytes[64];
    // A line that was silent does not make up for it, but for a nap of this thread.
    way.passedUntil = std::max(way.passedUntil, now - 0.01);
    const auto most = std::min<double>(sizeof bytes, (now - way.passedUntil) / byte_s_);
    const ssize_t size = most < 1 ? 0 : ::read(way.from, bytes, std::size_t(most));
    if (size <= 0) {
        if (most >= 1) // nothing was there
            way.passedUntil = now;
        return;
    }
    way.passedUntil += double(size) * byte_s_;
    for (ssize_t i = 0; i < size; ++i) {
        if (oneIn_ == 0 || random_() % oneIn_ != 0)
            continue;
        bytes[i] = char(bytes[i] ^ (1 + random_() % 255));
        ++damaged_;
    }
    if (::write(way.to, bytes, std::size_t(size)) == size)
        passed_ += quint64(size);
}

} // namespace hermes
