#pragma once

#include "protocol/scan/SampleClock.h"
#include "protocol/scan/ScannerModel.h"
#include "protocol/scan/ScannerProtocol.h"

namespace hermes::scan {

/// YDLIDAR: packets of up to 80 beams, with one of a single beam where the head passes its mark. Revolutions
/// are cut by the angle, as that packet may be lost. Source: the maker's protocol manual and SDK.
class Ydlidar : public ScannerProtocol {
public:
    enum class Kind {
        Triangulation, ///< X, G
        Tmini,         ///< the same with an intensity and marks of interference
        TimeOfFlight,  ///< TG
    };

    Ydlidar(Kind kind, const ScannerModel &model, RevolutionAssembler &revolutions);

    void jump() override;
    std::string farewell() const override;

private:
    enum Step { Wake, Stop, Info, Health, Reset, Begin, Scan };

    void restart();
    std::optional<Request> request(int step) const override;
    std::size_t take(std::string_view bytes, const Arrival &arrival) override;
    std::size_t takeAnswer(std::string_view bytes);
    std::size_t takePacket(std::string_view bytes, const Arrival &arrival);
    bool isRight(const std::uint8_t *bytes, int count) const;
    void takeInfo(const std::uint8_t *data);
    void addBeam(const std::uint8_t *beam, double head_deg, std::int64_t stamp_ns);

    const Kind kind_;
    const bool isOneWay_;
    const Motor motor_;
    const double byte_ns_;
    const std::size_t beamSize_;
    bool needsReset_ = false;

    SampleClock clock_;
    double step_deg_ = 0;     ///< between beams; 0: not known
    std::size_t skipped_ = 1; ///< bytes since the last packet
    int wrong_ = 0;           ///< checksums in a row
};

} // namespace hermes::scan
