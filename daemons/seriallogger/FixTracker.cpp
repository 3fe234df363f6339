#include "daemons/seriallogger/FixTracker.h"

namespace hermes {

namespace {

bool same(const std::optional<nmea::UtcTime> &a, const std::optional<nmea::UtcTime> &b) {
    return a && b && a->hour == b->hour && a->minute == b->minute && a->second == b->second;
}

} // namespace

std::optional<nmea::UtcTime> Fix::timeOfDay() const {
    return rmc && rmc->time ? rmc->time : gga ? gga->time : std::nullopt;
}

std::optional<double> Fix::time() const {
    if (!rmc || !rmc->date || !rmc->time)
        return std::nullopt;
    return nmea::toStamp(*rmc->date, *rmc->time);
}

bool Fix::isValid() const {
    return position() && (!rmc || rmc->valid) && (!gga || gga->quality > 0);
}

std::optional<nmea::Position> Fix::position() const {
    return rmc && rmc->position ? rmc->position : gga ? gga->position : std::nullopt;
}

void FixTracker::feed(std::string_view bytes, const Arrival &arrival, const Sink &sink) {
    for (const char byte : bytes) {
        const auto result = parser_.feed(byte);
        if (parser_.pending() == 1)
            sentenceArrival_ = arrival;
        if (result == nmea::SentenceParser::Result::Done)
            take(parser_.sentence(), sink);
    }
}

void FixTracker::take(const nmea::Sentence &sentence, const Sink &sink) {
    nmea::Rmc rmc;
    nmea::Gga gga;
    const bool isRmc = sentence.type() == "RMC";
    if (!isRmc && sentence.type() != "GGA")
        return;
    if (const nmea::FieldFault fault = isRmc ? decode(sentence, rmc) : decode(sentence, gga)) {
        ++badFields_;
        lastFault_ = fault;
        return;
    }
    const Kind kind = isRmc ? Kind::Rmc : Kind::Gga;
    add(kind, isRmc ? rmc.time : gga.time, sink);
    if (isRmc)
        fix_.rmc = rmc;
    else
        fix_.gga = gga;
    last_ = kind;
    if (!given_ && ((fix_.rmc && fix_.gga) || kind == closing_))
        give(sink);
}

void FixTracker::add(Kind kind, const std::optional<nmea::UtcTime> &time, const Sink &sink) {
    const bool isThere = kind == Kind::Rmc ? fix_.rmc.has_value() : fix_.gga.has_value();
    const bool isEmpty = !fix_.rmc && !fix_.gga;
    // Without a time a sentence belongs to the one before.
    if (!isEmpty && !isThere && (same(time, fix_.timeOfDay()) || !time || !fix_.timeOfDay()))
        return;
    if (!given_)
        give(sink);
    closing_ = last_;
    fix_ = Fix();
    fix_.arrival = sentenceArrival_;
    given_ = false;
}

void FixTracker::give(const Sink &sink) {
    given_ = true;
    sink(fix_);
}

void FixTracker::finish(const Sink &sink) {
    if (!given_)
        give(sink);
}

} // namespace hermes
