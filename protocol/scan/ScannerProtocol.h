#pragma once

#include "protocol/scan/RevolutionAssembler.h"

#include <optional>
#include <string>
#include <string_view>

namespace hermes::scan {

/// When bytes came in, in nanoseconds: since the Unix epoch, and by a clock that never jumps.
struct Arrival {
    std::int64_t stamp_ns = 0;
    std::int64_t mono_ns = 0;
};

/// What the host is to do now.
struct HostAction {
    std::string send;        ///< bytes; empty: nothing
    std::optional<bool> dtr; ///< to raise or lower that signal of the line, before it sends
    bool reopen = false;     ///< to close the line and open it again
};

/// What a scanner tells of itself; empty: not yet, or never.
struct ScannerIdentity {
    std::string model;    ///< as the device names it, or its number
    std::string firmware; ///< version
    std::string serial;   ///< number
};

/// The protocol of a family of scanners, from the bytes of the device to beams: a state machine without line
/// or clock. A scanner is asked one thing after the other until it measures, and anew when it falls silent or
/// does not answer; one that takes no commands has no such steps. Whoever replays a recording only feeds it.
class ScannerProtocol {
public:
    struct Counts {
        std::uint64_t packets = 0;      ///< with measurements, that were right
        std::uint64_t damaged = 0;      ///< by their checksums, or by what stands in them
        std::uint64_t skippedBytes = 0; ///< that belong to no packet
    };

    explicit ScannerProtocol(RevolutionAssembler &revolutions)
        : revolutions_(revolutions) {}
    virtual ~ScannerProtocol() = default;
    ScannerProtocol(const ScannerProtocol &) = delete;
    ScannerProtocol &operator=(const ScannerProtocol &) = delete;

    /// Takes bytes that came in together.
    void feed(std::string_view bytes, const Arrival &arrival);
    /// What comes next does not follow what came before: bytes were lost, or a replay was sought.
    virtual void jump();
    /// The line was opened: what is to be done begins anew. Only one that is live.
    void opened(std::int64_t mono_ns);
    /// What the host is to do, asked some 50 times a second and after each feed(). Only one that is live.
    HostAction next(std::int64_t mono_ns);

    /// What the host sends before it closes the line, so that the scanner rests; empty: nothing. Usually what
    /// it asks first.
    virtual std::string farewell() const;

    /// What somebody who begins to read in the middle must know; empty: nothing. For prepare().
    virtual std::string prerequisite() const { return {}; }
    virtual void prepare(const std::string &prerequisite) { (void)prerequisite; }

    /// Beams come, as far as the last second tells.
    bool isScanning() const { return isScanning_; }
    /// What is wrong, as a sentence for people; empty: nothing.
    const std::string &problem() const { return problem_; }
    const ScannerIdentity &identity() const { return identity_; }
    const Counts &counts() const { return counts_; }

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
    /// What RPLIDAR and YDLIDAR tell of their health: a state, and a code of two bytes. True: it needs a
    /// reset.
    bool takeHealth(const std::uint8_t *data);
    bool isMeasuring() const { return !isNew_ && !request_; }
    int attempts() const { return attempts_; } ///< in a row that failed

    RevolutionAssembler &revolutions_;
    Counts counts_;
    ScannerIdentity identity_;
    std::string problem_;
    std::string trouble_; ///< what the device told of itself since it measured, as a sentence

private:
    HostAction begin(int step, std::int64_t mono_ns);
    HostAction fail(const char *problem, std::int64_t mono_ns);

    std::string buffer_;
    bool isNew_ = true; ///< the first request is to be sent yet
    int step_ = 0;
    std::optional<Request> request_; ///< of this step
    std::int64_t since_ns_ = 0, lastBytes_ns_ = 0, lastPacket_ns_ = -1, lastAsked_ns_ = 0;
    bool isAnswered_ = false, isScanning_ = false;
    int attempts_ = 0;
};

} // namespace hermes::scan
