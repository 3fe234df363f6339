#pragma once

#include "protocol/scan/HostClock.h"
#include "protocol/scan/ScannerProtocol.h"

namespace hermes::scan {

/// Hokuyo URG, UTM and UST by SCIP 2: lines of text, each with a sum, in blocks that end with an empty line.
/// Sources: the maker's C-42-03320B (SCIP 2.0) and urg_c.
class Hokuyo : public ScannerProtocol {
public:
    explicit Hokuyo(RevolutionAssembler &revolutions);

    void jump() override;
    std::string prerequisite() const override;
    void prepare(const std::string &prerequisite) override;

private:
    enum Step { Quit, Scip, Clock, Version, Parameters, Laser, Begin };
    /// What PP tells, in steps of the head.
    struct Sweep {
        int around = -1; ///< steps of a revolution; -1: not told
        int first = -1, last = -1, ahead = -1, speed_rpm = -1;
    };

    std::optional<Request> request(int step) const override;
    std::size_t take(std::string_view bytes, const Arrival &arrival) override;
    bool takeBlock(std::string_view block);
    void takeFacts(std::string_view lines);
    void takeStatus(std::string_view command, std::string_view status);
    bool takeScan(std::string_view block, const Arrival &arrival);
    void tellLost(std::int64_t stamp_ns, double period_ns);
    static bool isPossible(const Sweep &sweep);

    Sweep sweep_;
    HostClock clock_;
    std::string values_; ///< of a scan, which lines divide anywhere
    bool isFirstScip_ = false, isClockMode_ = false;
    std::optional<std::int64_t> lastStamp_ns_; ///< of the scan before
    bool isBroken_ = false;                    ///< something between is damaged
};

} // namespace hermes::scan
