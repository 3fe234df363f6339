#pragma once

#include "common/Time.h"
#include "daemons/seriallogger/FixReport.h"

#include <array>
#include <string>
#include <vector>

namespace hermes::seriallogger {

/// What a GPS receiver said about one moment, in all its sentences; what it does not know is empty.
struct Fix {
    Moment arrival;             ///< of the first byte of the first sentence
    std::optional<double> time; ///< seconds since the epoch of the fix itself, by the satellites
    bool valid = false;         ///< the receiver vouches for it, in each sentence that says so or not
    std::optional<nmea::Position> position;
    std::optional<int> quality; ///< as of GGA
    std::optional<int> satellites;
    std::optional<double> hdop;
    std::optional<double> altitude; ///< above mean sea level, m
    std::optional<double> speed;    ///< m/s
    std::optional<double> course_deg;
};

/// Collects the sentences of one moment. Of a kind that more than one constellation sends, the first with a
/// valid position counts.
class FixEpoch {
public:
    /// What sentences can tell, whether the receiver knows it or not.
    static constexpr unsigned Position = 1, Quality = 2, Motion = 4, Date = 8, allParts = 15;

    /// arrival: of the first byte of its first sentence.
    explicit FixEpoch(const Moment &arrival)
        : arrival_(arrival) {}

    /// address: talker and type, "GPRMC".
    void add(std::string_view address, const FixReport &report);
    bool has(std::string_view address) const;
    /// Of those in it, the one that came last.
    std::string_view lastAddress() const { return addresses_.back(); }
    const std::optional<FixReport> &report(FixReport::Kind kind) const { return reports_[std::size_t(kind)]; }

    /// The parts that a report tells, and those that all reports tell.
    static unsigned parts(const FixReport &report);
    unsigned parts() const;
    /// One sentence vouches for the position, another does not.
    bool isContradictory() const;

    const Moment &arrival() const { return arrival_; }
    const std::optional<nmea::UtcTime> &timeOfDay() const { return time_; }
    const std::optional<nmea::Date> &date() const { return date_; }
    /// All but the time.
    Fix fix() const;

private:
    const Moment arrival_;
    std::vector<std::string> addresses_;
    std::array<std::optional<FixReport>, FixReport::kinds> reports_;
    std::optional<nmea::UtcTime> time_;
    std::optional<nmea::Date> date_;
};

} // namespace hermes::seriallogger
