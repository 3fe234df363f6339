#include "daemons/velodynelogger/UdpReceiver.h"

#include "daemons/velodynelogger/ThreadPriority.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace hermes::velodynelogger {

namespace {

// What comes in this time is taken together; the kernel has stamped each. To wake for every packet, half a
// millisecond apart, took most of the logger's time.
constexpr int rest_ms = 4;

} // namespace

UdpReceiver::UdpReceiver(Sink sink)
    : sink_(std::move(sink)) {}

UdpReceiver::~UdpReceiver() {
    stop();
}

Outcome<void> UdpReceiver::start(const Options &options) {
    stop();
    failed_ = false;
    received_ = kernelDrops_ = tooLong_ = 0;
    if (const auto opened = data_.open(options.address, options.port, options.bufferBytes); !opened)
        return opened;
    positionError_.reset();
    if (options.positionPort != 0)
        if (const auto opened = position_.open(options.address, options.positionPort, options.bufferBytes);
            !opened)
            positionError_ = opened.error();
    wake_ = ::eventfd(0, EFD_CLOEXEC);
    if (wake_ < 0) {
        const std::string why = std::strerror(errno);
        stop();
        return "no event descriptor: " + why;
    }
    thread_ = std::thread([this] { run(); });
    return {};
}

void UdpReceiver::stop() {
    if (thread_.joinable()) {
        const std::uint64_t one = 1;
        if (::write(wake_, &one, sizeof one) == sizeof one)
            thread_.join();
        else
            std::abort(); // an eventfd that was never written to cannot be full
    }
    data_.close();
    position_.close();
    if (wake_ >= 0)
        ::close(wake_);
    wake_ = -1;
}

void UdpReceiver::run() {
    preferThisThread();
    pollfd waits[] = {
        {wake_, POLLIN, 0}, {data_.descriptor(), POLLIN, 0}, {position_.descriptor(), POLLIN, 0}};
    for (;;) {
        if (::poll(waits, 3, -1) < 0 && errno != EINTR) // a descriptor of -1 is left out
            break;
        if (waits[0].revents)
            return;
        if (!receive())
            break;
        deliver();
        const bool mayRest = !data_.mayHaveMore() && !position_.mayHaveMore();
        if (mayRest && ::poll(waits, 1, rest_ms) > 0)
            return;
    }
    error_ = "receiving on UDP port " + std::to_string(data_.port()) + " failed: " + std::strerror(errno);
    failed_ = true;
}

bool UdpReceiver::receive() {
    const bool fine = data_.receive();
    return (position_.descriptor() < 0 || position_.receive()) && fine;
}

/// In the order in which the kernel got them, over both ports.
void UdpReceiver::deliver() {
    std::size_t d = 0, p = 0;
    while (d < data_.count() || p < position_.count()) {
        const bool fromData =
            p == position_.count() ||
            (d < data_.count() && data_.datagram(d).stamp_ns <= position_.datagram(p).stamp_ns);
        sink_.datagram(fromData ? data_.datagram(d++) : position_.datagram(p++));
    }
    const Losses losses{std::uint64_t(data_.drops()) + position_.drops(), data_.cut() + position_.cut()};
    received_ += d + p + losses.tooLong;
    kernelDrops_ += losses.kernel;
    tooLong_ += losses.tooLong;
    if (losses.kernel + losses.tooLong > 0)
        sink_.lost(losses);
    sink_.pause();
}

UdpReceiver::Counts UdpReceiver::counts() const {
    return {received_, kernelDrops_, tooLong_, data_.bufferBytes()};
}

} // namespace hermes::velodynelogger
