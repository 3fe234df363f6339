#include "daemons/seriallogger/FixTracker.h"

#include <algorithm>
#include <cmath>

namespace hermes::seriallogger {

namespace {

// A pause is half of the time from fix to fix: no receiver is silent for so long amid its sentences. USB
// adapters may hold bytes back for 16 ms; nobody should wait for half a second.
constexpr double leastPause_s = 0.05, maxPause_s = 0.5;

double secondOfDay(const nmea::UtcTime &time) {
    return time.hour * 3600 + time.minute * 60 + time.second;
}

/// Some write fewer decimals in one kind of sentence than in another, rounded or cut.
bool isSame(const std::optional<nmea::UtcTime> &a, const std::optional<nmea::UtcTime> &b) {
    const bool isRounded = a && b && a->decimals != b->decimals;
    return a && b && std::abs(secondOfDay(*a) - secondOfDay(*b)) < (isRounded ? 0.0099 : 0.0001);
}

} // namespace

void FixTracker::feed(std::string_view bytes, const Moment &arrival, const Sink &sink) {
    if (last_ && arrival.mono_ns - last_->mono_ns >= pause_ns())
        paused_ = true;
    last_ = arrival;
    for (const char byte : bytes) {
        const auto result = parser_.feed(byte);
        if (parser_.pending() == 1)
            sentenceArrival_ = arrival;
        if (result == nmea::SentenceParser::Result::Done)
            take(parser_.sentence(), sink);
    }
    if (parser_.endPiece() == nmea::SentenceParser::Result::Done)
        take(parser_.sentence(), sink);
}

std::int64_t FixTracker::pause_ns() const {
    return std::int64_t(std::clamp(period_s_ / 2, leastPause_s, maxPause_s) * 1e9);
}

std::optional<std::int64_t> FixTracker::waitUntilMono_ns() const {
    return waits() && last_ ? std::optional(last_->mono_ns + pause_ns()) : std::nullopt;
}

void FixTracker::pause(const Sink &sink) {
    if (waits())
        give(sink);
    paused_ = true;
}

void FixTracker::take(const nmea::Sentence &sentence, const Sink &sink) {
    nmea::FieldFault fault;
    const std::optional<FixReport> report = FixReport::read(sentence, fault);
    if (fault) {
        ++counts_.badFields;
        lastFault_ = fault;
    }
    if (!report)
        return;
    if (report->date && report->time)
        calendar_.set(*report->date, *report->time, sentenceArrival_);
    if (isOfTheEpochBefore(*report) || isRepeated(sentence.address(), *report)) {
        ++counts_.repeated;
        return;
    }
    if (!isOfThisEpoch(sentence.address(), *report))
        begin(sink);
    else if (given_ && (paused_ || (FixEpoch::parts(*report) & ~known()) != 0))
        ++counts_.late;
    paused_ = false;
    epoch_->add(sentence.address(), *report);
    if (!given_ && isComplete())
        give(sink);
}

/// Then it is repeated or came out of order; but after a pause the receiver's clock was set back.
bool FixTracker::isOfTheEpochBefore(const FixReport &report) const {
    const bool isOfThis = epoch_ && isSame(report.time, epoch_->timeOfDay());
    return !paused_ && !isOfThis && isSame(report.time, before_);
}

/// Without times one that follows itself is, and a VTG that tells the same.
bool FixTracker::isRepeated(std::string_view address, const FixReport &report) const {
    if (paused_ || !epoch_ || !epoch_->has(address))
        return false;
    if (report.time && epoch_->timeOfDay())
        return isSame(report.time, epoch_->timeOfDay());
    const std::optional<FixReport> &held = epoch_->report(report.kind);
    if (report.kind == FixReport::Kind::Vtg)
        return held && held->speed == report.speed && held->course_deg == report.course_deg;
    return epoch_->lastAddress() == address && !report.time;
}

bool FixTracker::isOfThisEpoch(std::string_view address, const FixReport &report) const {
    if (!epoch_)
        return false;
    if (report.time && epoch_->timeOfDay())
        return isSame(report.time, epoch_->timeOfDay()) && !(paused_ && epoch_->has(address));
    return !paused_ && !epoch_->has(address) && !(report.time && given_);
}

/// Ends the epoch, and begins one with the sentence at hand.
void FixTracker::begin(const Sink &sink) {
    if (waits())
        give(sink);
    if (epoch_)
        learn();
    epoch_.emplace(sentenceArrival_);
    given_ = false;
}

void FixTracker::learn() {
    if (epoch_->parts() & FixEpoch::Position)
        told_[epochs_++ % told_.size()] = epoch_->parts();
    if (!epoch_->timeOfDay())
        return;
    const double step = before_ ? secondOfDay(*epoch_->timeOfDay()) - secondOfDay(*before_) : 0;
    if (step > 0)
        period_s_ = std::min(step, period_s_ * 1.1); // a lost one makes no slower receiver
    before_ = epoch_->timeOfDay();
}

unsigned FixTracker::known() const {
    return epoch_->parts() | (calendar_.isSet() ? FixEpoch::Date : 0U);
}

bool FixTracker::isComplete() const {
    unsigned expected = epochs_ > 0 ? 0 : FixEpoch::allParts;
    for (const unsigned parts : told_)
        expected |= parts;
    return (epoch_->parts() & FixEpoch::Position) && (expected & ~known()) == 0 && !epoch_->isContradictory();
}

void FixTracker::give(const Sink &sink) {
    given_ = true;
    Fix fix = epoch_->fix();
    if (const auto &time = epoch_->timeOfDay())
        fix.time = epoch_->date() ? nmea::toStamp(*epoch_->date(), *time)
                                  : calendar_.stampOf(*time, epoch_->arrival());
    sink(fix);
}

} // namespace hermes::seriallogger
