#include "protocol/scan/ScannerDialogue.h"

#include <algorithm>
#include <utility>

namespace hermes::scan {
namespace {

constexpr std::int64_t millisecond_ns = 1000000;
constexpr int quiet_ms = 100, drain_ms = 1000; // what counts as silence, and how long that is waited for
constexpr int spinUp_ms = 3000;                // a motor comes to its speed
constexpr int silent_ms = 1000;
constexpr int attemptsOfLine = 3;

} // namespace

void ScannerDialogue::feed(std::string_view bytes, const Arrival &arrival) {
    lastBytes_ns_ = arrival.mono_ns;
    buffer_ += bytes;
    std::size_t used = 0;
    while (used < buffer_.size()) {
        const std::size_t size = take(std::string_view(buffer_).substr(used), arrival);
        if (size == more)
            break;
        counts_.skippedBytes += size == 0;
        used += std::max<std::size_t>(size, 1);
    }
    buffer_.erase(0, used);
}

void ScannerDialogue::jump() {
    buffer_.clear();
    isScanning_ = false;
    revolutions_.jump();
}

void ScannerDialogue::measured(const Arrival &arrival) {
    ++counts_.packets;
    lastPacket_ns_ = arrival.mono_ns;
    isScanning_ = true;
    trouble_.clear();
}

void ScannerDialogue::opened(std::int64_t mono_ns) {
    jump();
    isNew_ = true;
    attempts_ = 0;
    lastBytes_ns_ = mono_ns;
}

HostAction ScannerDialogue::begin(int step, std::int64_t mono_ns) {
    isNew_ = isAnswered_ = false;
    step_ = step;
    since_ns_ = mono_ns;
    request_ = request(step);
    HostAction action;
    if (request_) {
        action.send = request_->send;
        action.dtr = request_->dtr;
    }
    return action;
}

HostAction ScannerDialogue::fail(const char *problem, std::int64_t mono_ns) {
    problem_ = trouble_.empty() ? problem : std::exchange(trouble_, {});
    ++attempts_;
    jump();
    HostAction action = begin(0, mono_ns);
    action.reopen = attempts_ >= attemptsOfLine || !request_; // nothing else can be done
    return action;
}

HostAction ScannerDialogue::next(std::int64_t mono_ns) {
    if (isNew_)
        return begin(0, mono_ns);
    const std::int64_t since_ms = (mono_ns - since_ns_) / millisecond_ns;
    const bool measures = lastPacket_ns_ > since_ns_; // since this step began
    if (!request_) {
        isScanning_ = lastPacket_ns_ >= 0 && mono_ns - lastPacket_ns_ < silent_ms * millisecond_ns;
        if (isScanning_) {
            attempts_ = 0;
            problem_ = trouble_;
            return {};
        }
        return since_ms < spinUp_ms && !measures ? HostAction()
                                                 : fail("no measurement came for a second", mono_ns);
    }
    switch (request_->until) {
    case Until::Silence:
        if (mono_ns - std::max(lastBytes_ns_, since_ns_) < quiet_ms * millisecond_ns && since_ms < drain_ms)
            return {};
        break;
    case Until::Time:
        if (!isAnswered_ && since_ms < request_->wait_ms)
            return {};
        break;
    case Until::Answer:
        if (isAnswered_)
            break;
        if (since_ms < request_->wait_ms)
            return {};
        if (!measures)
            return fail("the scanner does not answer: another device, another baud rate, or too little power",
                        mono_ns);
        request_.reset(); // it measures whatever it is asked
        return {};
    }
    return begin(step_ + 1, mono_ns);
}

std::string ScannerDialogue::farewell() const {
    const auto first = request(0);
    return first ? first->send : std::string();
}

} // namespace hermes::scan
