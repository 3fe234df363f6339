#pragma once

#include "protocol/scan/HostClock.h"
#include "protocol/scan/ScannerProtocol.h"

#include <vector>

namespace hermes::scan {

/// SICK TiM and LMS by CoLa A: telegrams of words between STX and ETX, numbers in hexadecimal. They have no
/// checksum. Source: the maker's telegram listings and driver (sick_scan_xd).
class SickCola : public ScannerProtocol {
public:
    explicit SickCola(RevolutionAssembler &revolutions);

    void jump() override;

private:
    enum Step { Stop, Access, Start, Run, Begin };
    struct Channel { ///< of a scan
        std::size_t first = 0, count = 0;
        double scale = 0, offset = 0, start_deg = 0, step_deg = 0;
    };

    std::optional<Request> request(int step) const override;
    std::size_t take(std::string_view bytes, const Arrival &arrival) override;
    void takeTelegram(const Arrival &arrival);
    bool takeScan(const Arrival &arrival);
    void takeChannels(std::size_t at, Channel &ranges, Channel &intensities);
    static bool isPossible(const Channel &channel);
    void tellLost(std::uint32_t telegram);
    std::uint32_t hex(std::size_t index);

    HostClock clock_;
    std::vector<std::string_view> words_; ///< of a telegram
    bool isRight_ = true;                 ///< all words that were read are numbers
    std::optional<std::uint32_t> telegram_;
};

} // namespace hermes::scan
