#pragma once

#include "protocol/scan/ScannerProtocol.h"

namespace hermes::scan {

/// A scanner that is asked one thing after the other until it measures, and anew when it falls silent or does
/// not answer. One that takes no commands has no such steps.
class ScannerDialogue : public ScannerProtocol {
public:
    using ScannerProtocol::ScannerProtocol;

    void feed(std::string_view bytes, const Arrival &arrival) final;
    /// The first request is to stop.
    std::string farewell() const override;
    void jump() override;
    void opened(std::int64_t mono_ns) final;
    HostAction next(std::int64_t mono_ns) final;
    bool isScanning() const final { return isScanning_; }

protected:
    /// What ends a step.
    enum class Until {
        Answer,  ///< answered(), within the time; else all begins anew
        Silence, ///< for 100 ms: what it streamed before has ended
        Time,    ///< passes, or answered()
    };
    struct Request {
        Until until = Until::Time;
        std::string send = {};
        int wait_ms = 0;
        std::optional<bool> dtr = {};
    };
    static constexpr std::size_t more = std::string_view::npos;

    /// What is asked as step so and so, from 0; nothing: now it measures.
    virtual std::optional<Request> request(int step) const = 0;
    /// Takes what the bytes begin with and returns its size. 0: nothing begins there; more: its end has not
    /// come.
    virtual std::size_t take(std::string_view bytes, const Arrival &arrival) = 0;

    /// What this step asks was answered.
    void answered(int step) { isAnswered_ = isAnswered_ || step == step_; }
    /// A packet with measurements came.
    void measured(const Arrival &arrival);
    bool isMeasuring() const { return !isNew_ && !request_; }
    int attempts() const { return attempts_; } ///< in a row that failed

    std::string trouble_; ///< what the device told of itself since it measured, as a sentence

private:
    HostAction begin(int step, std::int64_t mono_ns);
    HostAction fail(const char *problem, std::int64_t mono_ns);

    std::string buffer_;
    bool isNew_ = true; ///< the first request is to be sent yet
    int step_ = 0;
    std::optional<Request> request_; ///< of this step
    std::int64_t since_ns_ = 0, lastBytes_ns_ = 0, lastPacket_ns_ = -1;
    bool isAnswered_ = false, isScanning_ = false;
    int attempts_ = 0;
};

} // namespace hermes::scan
