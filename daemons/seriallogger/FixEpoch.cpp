#include "daemons/seriallogger/FixEpoch.h"

#include <algorithm>

namespace hermes::seriallogger {

namespace {

/// More is better.
int rank(const FixReport &report) {
    return report.valid == true && report.position ? 2 : report.valid.has_value() ? 1 : 0;
}

/// Where there is none yet.
template <typename T>
void fill(std::optional<T> &value, const std::optional<T> &from) {
    if (!value)
        value = from;
}

} // namespace

void FixEpoch::add(std::string_view address, const FixReport &report) {
    if (!has(address))
        addresses_.emplace_back(address);
    fill(time_, report.time);
    fill(date_, report.date);
    std::optional<FixReport> &held = reports_[std::size_t(report.kind)];
    if (!held || rank(report) > rank(*held))
        held = report;
}

bool FixEpoch::has(std::string_view address) const {
    return std::find(addresses_.begin(), addresses_.end(), address) != addresses_.end();
}

unsigned FixEpoch::parts(const FixReport &report) {
    const bool judged = report.valid.has_value();
    switch (report.kind) {
    case FixReport::Kind::Rmc:
        return Position | Motion | Date;
    case FixReport::Kind::Gga:
    case FixReport::Kind::Gns:
        return judged ? Position | Quality : 0U;
    case FixReport::Kind::Gll:
        return Position;
    case FixReport::Kind::Vtg:
        return Motion;
    case FixReport::Kind::Zda:
        return Date;
    }
    return 0;
}

unsigned FixEpoch::parts() const {
    unsigned all = 0;
    for (const std::optional<FixReport> &report : reports_)
        all |= report ? parts(*report) : 0;
    return all;
}

bool FixEpoch::isContradictory() const {
    const auto says = [this](bool valid) {
        return std::any_of(reports_.begin(), reports_.end(),
                           [valid](const auto &report) { return report && report->valid == valid; });
    };
    return says(true) && says(false);
}

Fix FixEpoch::fix() const {
    Fix fix;
    fix.arrival = arrival_;
    bool vouched = false, doubted = false;
    for (const std::optional<FixReport> &report : reports_) {
        if (!report)
            continue;
        vouched = vouched || report->valid == true;
        doubted = doubted || report->valid == false;
        fill(fix.position, report->position);
        fill(fix.quality, report->quality);
        fill(fix.satellites, report->satellites);
        fill(fix.hdop, report->hdop);
        fill(fix.altitude, report->altitude);
        fill(fix.speed, report->speed);
        fill(fix.course_deg, report->course_deg);
    }
    fix.valid = fix.position && vouched && !doubted;
    return fix;
}

} // namespace hermes::seriallogger
