#include "daemons/velodynelogger/LiveSource.h"

namespace hermes::velodynelogger {

namespace {

constexpr std::chrono::milliseconds ringTimeout{1000}; // a wait ends as soon as something comes

} // namespace

LiveSource::LiveSource(Recorder &recorder, Sink decode)
    : recorder_(recorder)
    , decode_(std::move(decode))
    , receiver_(
          {[this](const Datagram &datagram) { take(datagram); },
           [this](const UdpReceiver::Losses &losses) { recorder_.noteLosses(losses.kernel, losses.tooLong); },
           [this] { ring_.wake(); }}) {}

LiveSource::~LiveSource() {
    stop();
}

Outcome<void> LiveSource::start(const UdpReceiver::Options &options) {
    stop();
    drops_ = 0;
    stopping_ = false;
    ring_.interrupt(false);
    const Outcome<void> started = receiver_.start(options);
    if (started)
        thread_ = std::thread([this] { run(); });
    return started;
}

void LiveSource::stop() {
    receiver_.stop();
    stopping_ = true;
    ring_.interrupt();
    if (thread_.joinable())
        thread_.join();
}

void LiveSource::take(const Datagram &datagram) {
    recorder_.push(datagram, false);
    if (!ring_.push(datagram))
        ++drops_;
}

void LiveSource::run() {
    Datagram datagram;
    for (;;) {
        while (ring_.front(datagram)) {
            decode_(datagram);
            ring_.pop();
        }
        if (stopping_ && ring_.used() == 0)
            return;
        ring_.wait(ringTimeout);
    }
}

LiveSource::Counts LiveSource::counts() const {
    Counts counts;
    static_cast<UdpReceiver::Counts &>(counts) = receiver_.counts();
    counts.decoderDrops = drops_;
    return counts;
}

} // namespace hermes::velodynelogger
