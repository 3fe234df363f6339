#pragma once

#include "protocol/scan/HostClock.h"
#include "protocol/scan/ScannerProtocol.h"

namespace hermes::scan {

/// LDROBOT LD06, LD19 and STL-27L: packets of twelve beams, which the scanner sends as soon as it turns. It
/// takes no commands. Source: the maker's manual of the LD06 (v1.0) and driver (ldlidar_stl_ros2).
class Ldrobot : public ScannerProtocol {
public:
    /// samples_hz: beams that it measures in a second.
    Ldrobot(int samples_hz, int baud, RevolutionAssembler &revolutions);

    void jump() override;

private:
    std::optional<Request> request(int) const override { return {}; }
    std::size_t take(std::string_view bytes, const Arrival &arrival) override;
    void tellLost(double first_deg, double step_deg, int stamp_ms);
    void takePacket(const std::uint8_t *bytes, const Arrival &arrival, std::size_t bytesSince);

    const double sample_ns_, byte_ns_;
    HostClock clock_;
    std::optional<int> stamp_ms_; ///< of the packet before
    double head_deg_ = 0;         ///< of its last beam
};

} // namespace hermes::scan
