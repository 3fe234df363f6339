#pragma once

#include "protocol/scan/RplidarPackets.h"
#include "protocol/scan/ScannerProtocol.h"

#include <array>

namespace hermes::scan {

/// Slamtec RPLIDAR, series A, C and S on serial lines. Asked who it is and how it is, its motor is started,
/// and the mode that it calls typical is taken. Source: the maker's interface manual and SDK (2.1).
class Rplidar : public ScannerProtocol {
public:
    /// turnsByDtr: the motor needs DTR low.
    Rplidar(int baud, bool turnsByDtr, RevolutionAssembler &revolutions);

    void jump() override;
    std::string prerequisite() const override;
    void prepare(const std::string &prerequisite) override;
    /// Its motor stands then, too, unless DTR turns it.
    std::string farewell() const override;

private:
    enum Step { Stop, Info, Health, Reset, MotorKind, Motor, Mode, Period, Form, Rates, Express, Standard };

    std::optional<Request> request(int step) const override;
    std::size_t take(std::string_view bytes, const Arrival &arrival) override;
    std::size_t takeAnswer(std::string_view bytes);
    void takeInfo(const std::uint8_t *data);
    void takeConf(std::uint32_t what, const std::uint8_t *value, std::size_t size);
    bool hasModes() const;
    bool isOfS() const { return model_ >> 4 >= 6; }

    RplidarPackets packets_;
    const bool turnsByDtr_;
    bool needsReset_ = false;

    int model_ = 0, firmware_ = 0; ///< 124 is 1.24
    bool hasPwm_ = false;
    int mode_ = 0, form_ = 0x82;
    double sample_us_ = 0;          ///< for each beam in the mode; 0: not told
    std::array<int, 2> rates_us_{}; ///< the same, of form 81 and of express scans, as older ones tell it
    std::size_t skipped_ = 1;       ///< bytes since the last packet
};

} // namespace hermes::scan
