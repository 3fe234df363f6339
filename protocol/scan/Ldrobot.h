#pragma once

#include "protocol/scan/HostClock.h"
#include "protocol/scan/ScannerProtocol.h"

#include <array>

namespace hermes::scan {

/// LDROBOT LD06, LD19 and STL-27L: packets of twelve beams, which the scanner sends as soon as it turns. It
/// takes no commands. Source: the maker's manual of the LD06 (v1.0) and driver (ldlidar_stl_ros2).
class Ldrobot : public ScannerProtocol {
public:
    /// samples_hz: beams that it measures in a second.
    Ldrobot(int samples_hz, int baud, RevolutionAssembler &revolutions);

    void feed(std::string_view bytes, const Arrival &arrival) override;
    void jump() override;
    void opened(std::int64_t mono_ns) override { lastPacket_ns_ = mono_ns; }
    HostAction next(std::int64_t mono_ns) override;
    bool isScanning() const override { return isScanning_; }

private:
    static constexpr std::size_t packetSize = 47;

    void tellLost(double first_deg, double step_deg, int stamp_ms);
    bool takePacket(const std::uint8_t *bytes, const Arrival &arrival, std::size_t bytesBehind);

    const double sample_ns_, byte_ns_;
    std::array<std::uint8_t, packetSize> packet_{};
    std::size_t filled_ = 0;
    HostClock clock_;
    std::optional<int> stamp_ms_; ///< of the packet before
    double head_deg_ = 0;         ///< of its last beam
    std::int64_t lastPacket_ns_ = 0;
    bool isScanning_ = false;
};

} // namespace hermes::scan
