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

/// The protocol of a family of scanners, from the bytes of the device to beams, and what the host has to ask
/// it: a state machine without line or clock. Whoever replays a recording only feeds it.
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
    virtual void feed(std::string_view bytes, const Arrival &arrival) = 0;
    /// What comes next does not follow what came before: bytes were lost, or a replay was sought.
    virtual void jump() = 0;
    /// The line was opened: what is to be done begins anew. Only one that is live.
    virtual void opened(std::int64_t mono_ns) = 0;
    /// What the host is to do, asked some 50 times a second and after each feed(). Only one that is live.
    virtual HostAction next(std::int64_t mono_ns) = 0;

    /// What the host sends before it closes the line, so that the scanner rests; empty: nothing.
    virtual std::string farewell() const { return {}; }

    /// What somebody who begins to read in the middle must know; empty: nothing. For prepare().
    virtual std::string prerequisite() const { return {}; }
    virtual void prepare(const std::string &prerequisite) { (void)prerequisite; }

    /// Beams come, as far as the last second tells.
    virtual bool isScanning() const = 0;
    /// What is wrong, as a sentence for people; empty: nothing.
    const std::string &problem() const { return problem_; }
    const ScannerIdentity &identity() const { return identity_; }
    const Counts &counts() const { return counts_; }

protected:
    RevolutionAssembler &revolutions_;
    Counts counts_;
    ScannerIdentity identity_;
    std::string problem_;
};

} // namespace hermes::scan
