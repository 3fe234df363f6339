#pragma once

#include "protocol/scan/RevolutionAssembler.h"
#include "protocol/scan/SampleClock.h"
#include "protocol/scan/ScannerProtocol.h"

namespace hermes::scan {

/// The packets with measurements of an RPLIDAR, in any of the forms that the host can ask for: 81 (one beam),
/// 82 (express), 84 (ultra), 85 (dense), 86 (ultra dense). All but the first have a checksum, and tell only
/// with the next packet where their beams lie.
class RplidarPackets {
public:
    RplidarPackets(int baud, RevolutionAssembler &revolutions);

    /// From now on come packets of this form, a beam each so many microseconds.
    void begin(int form, double sample_us);
    static std::size_t sizeOf(int form); ///< bytes of its packets; 0: there is none
    static bool isForm(int form) { return sizeOf(form) > 0; }
    int form() const { return form_; } ///< 0: none
    double sample_us() const { return clock_.sample_ns() * 1e-3; }
    std::size_t size() const { return sizeOf(form_); } ///< bytes of a packet

    /// Bytes that isPacket() looks at.
    std::size_t needed() const { return form_ == 0x81 && isGap_ ? 4 * size() : size(); }
    /// Whether a packet can begin there.
    bool isPacket(const std::uint8_t *bytes) const;
    /// Takes one that is. bytesSince: that came in together, from its beginning.
    void take(const std::uint8_t *bytes, const Arrival &arrival, std::size_t bytesSince);
    /// Something is damaged before the next.
    void lose();
    void jump();

private:
    struct Raw {               ///< one beam
        double offset_deg = 0; ///< of the head behind it
        float range_m = 0;
        std::uint8_t intensity = 0;
    };

    static int beamsOf(int form);
    void decode(const std::uint8_t *bytes, const std::uint8_t *following);
    void decodeUltra(const std::uint8_t *bytes, const std::uint8_t *following);
    void decodeUltraDense(const std::uint8_t *bytes);

    const double byte_ns_;
    RevolutionAssembler &revolutions_;
    int form_ = 0;

    SampleClock clock_;
    bool isGap_ = true; ///< before the next
    static constexpr std::size_t maxSize = 170;
    std::uint8_t last_[maxSize]{}; ///< the packet before, whose beams are not told yet
    bool hasLast_ = false;
    std::int64_t end_ns_ = 0; ///< when its last beam was measured
    double head_deg_ = 0;     ///< of its first beam
    double step_deg_ = 0;     ///< between beams; 0: not known
    std::vector<Raw> raw_;
};

} // namespace hermes::scan
