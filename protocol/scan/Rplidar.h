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

    void feed(std::string_view bytes, const Arrival &arrival) override;
    void jump() override;
    void opened(std::int64_t mono_ns) override;
    HostAction next(std::int64_t mono_ns) override;
    std::string prerequisite() const override;
    void prepare(const std::string &prerequisite) override;
    bool isScanning() const override { return step_ == Step::Scan && packetsOfScan_ > 0; }

private:
    /// What is asked, in this order.
    enum class Step { Stop, Info, Health, Reset, MotorKind, Motor, Mode, Period, Form, Rates, Begin, Scan };

    std::size_t takeAnswer(std::string_view bytes);
    void takeInfo(std::string_view data);
    void takeHealth(std::string_view data);
    void takeConf(std::string_view data);
    HostAction begin(Step step, std::int64_t mono_ns);
    Step after(Step step) const;
    std::string request() const;
    bool hasModes() const;
    void fail(const std::string &problem);

    RplidarPackets packets_;
    std::string buffer_;
    bool turnsByDtr_;

    Step step_ = Step::Stop;
    std::int64_t stepSince_ns_ = 0, lastBytes_ns_ = 0, lastPacket_ns_ = 0;
    bool isAnswered_ = false;         ///< what this step asks
    std::uint64_t packetsOfScan_ = 0; ///< since it began
    int attempts_ = 0;                ///< in a row that failed
    bool needsReset_ = false;

    int model_ = 0, firmware_ = 0; ///< 124 is 1.24
    bool hasPwm_ = false;
    int mode_ = 0, form_ = 0x82;
    double sample_us_ = 0;          ///< for each beam in the mode; 0: not told
    std::array<int, 2> rates_us_{}; ///< the same, of form 81 and of express scans, as older ones tell it
    std::size_t skipped_ = 0;       ///< bytes since the last packet
};

} // namespace hermes::scan
