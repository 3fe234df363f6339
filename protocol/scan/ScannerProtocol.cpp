#include "protocol/scan/ScannerProtocol.h"

#include "protocol/scan/LittleEndian.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace hermes::scan {
namespace {

constexpr std::int64_t millisecond_ns = 1000000;
constexpr int quiet_ms = 100, drain_ms = 1000; // what counts as silence, and how long that is waited for
constexpr int spinUp_ms = 3000;                // a motor comes to its speed
constexpr int silent_ms = 1000;
constexpr std::int64_t longestRest_ns = 100 * millisecond_ns; // between two questions what is to be done
constexpr int attemptsOfLine = 3;

} // namespace

void ScannerProtocol::feed(std::string_view bytes, const Arrival &arrival) {
    lastBytes_ns_ = arrival.mono_ns;
    revolutions_.setClockAhead(arrival.stamp_ns - arrival.mono_ns);
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

void ScannerProtocol::jump() {
    buffer_.clear();
    isScanning_ = false;
    revolutions_.jump();
}

void ScannerProtocol::measured(const Arrival &arrival) {
    ++counts_.packets;
    lastPacket_ns_ = arrival.mono_ns;
    isScanning_ = true;
    trouble_.clear();
}

bool ScannerProtocol::takeHealth(const std::uint8_t *data) {
    const bool needsReset = data[0] == 2;
    char text[80];
    std::snprintf(text, sizeof text, "the scanner tells of a fault, code %04X%s", unsigned(word(data + 1)),
                  needsReset ? "; it is reset" : "");
    if (data[0] != 0)
        problem_ = trouble_ = text;
    return needsReset;
}

void ScannerProtocol::opened(std::int64_t mono_ns) {
    jump();
    isNew_ = true;
    attempts_ = 0;
    lastBytes_ns_ = lastAsked_ns_ = mono_ns;
}

HostAction ScannerProtocol::begin(int step, std::int64_t mono_ns) {
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

HostAction ScannerProtocol::fail(const char *problem, std::int64_t mono_ns) {
    problem_ = trouble_.empty() ? problem : std::exchange(trouble_, {});
    ++attempts_;
    jump();
    HostAction action = begin(0, mono_ns);
    action.reopen = attempts_ >= attemptsOfLine || !request_; // nothing else can be done
    return action;
}

HostAction ScannerProtocol::next(std::int64_t mono_ns) {
    // While the host was held up the scanner may have sent what has not been read yet.
    const std::int64_t held_ns = mono_ns - std::exchange(lastAsked_ns_, mono_ns) - longestRest_ns;
    if (held_ns > 0)
        for (std::int64_t *const since_ns : {&since_ns_, &lastBytes_ns_, &lastPacket_ns_})
            *since_ns += *since_ns >= 0 ? held_ns : 0;
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

std::string ScannerProtocol::farewell() const {
    const auto first = request(0);
    return first ? first->send : std::string();
}

} // namespace hermes::scan
