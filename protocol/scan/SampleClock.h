#pragma once

#include "protocol/scan/HostClock.h"

#include <optional>

namespace hermes::scan {

/// When a scanner without a clock measured: its beams are one, as it measures them at a steady rate. Of beams
/// that are missing the angle tells how many, but for whole revolutions, which the host's clock tells.
class SampleClock {
public:
    struct Packet {
        double head_deg = 0; ///< of its first beam, clockwise
        int beams = 0;
        bool isBehindGap = false;     ///< something between is damaged
        std::int64_t measured_ns = 0; ///< its last beam, by when the packet came in; a clock that never jumps
    };
    struct Time {
        std::int64_t stamp_ns; ///< of the last beam, by that clock
        std::int64_t bound_ns; ///< how far that may be off
        std::uint64_t lost;    ///< packets before this one
        bool slips;            ///< by whole revolutions from those before
    };

    /// sample_ns: for each beam. tolerance: beams that packets may lie beside each other. beams: of a packet,
    /// as far as it is known.
    SampleClock(double sample_ns, double tolerance, int beams)
        : usual_ns_(sample_ns)
        , sample_ns_(sample_ns)
        , tolerance_(tolerance)
        , fullBeams_(beams) {}

    Time take(const Packet &packet);
    /// Where the head of the next beam will be, and how far apart beams are; 0: not known.
    void expect(double head_deg, double step_deg);
    /// What follows is of another time.
    void jump();

    double sample_ns() const { return sample_ns_; }
    int fullBeams() const { return fullBeams_; } ///< of the largest packet

private:
    void followRate(double beams, std::int64_t mono_ns);

    static constexpr std::int64_t period_ns = 3600000000000;

    HostClock clock_{period_ns, HostClock::Receiver::NeverJumps};
    double usual_ns_, sample_ns_;
    double tolerance_;
    int fullBeams_;
    std::optional<double> head_deg_; ///< of the next beam
    double step_deg_ = 0;
    double sensor_ns_ = 0;          ///< by the beams that came
    std::int64_t last_ns_ = 0;      ///< stamp of the packet before
    std::int64_t rateSince_ns_ = 0; ///< the rate is measured since then
    double rateBeams_ = 0;          ///< by so many beams
    double windowBefore_ns_ = 0;    ///< that the last time of measuring told
};

} // namespace hermes::scan
