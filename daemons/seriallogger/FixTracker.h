#pragma once

#include "daemons/seriallogger/Arrival.h"
#include "protocol/nmea/Gga.h"
#include "protocol/nmea/Rmc.h"
#include "protocol/nmea/SentenceParser.h"

#include <functional>

namespace hermes {

/// What a GPS receiver said about one moment, in one or both of its sentences.
struct Fix {
    Arrival arrival; ///< of the first byte of the first sentence
    std::optional<nmea::Rmc> rmc;
    std::optional<nmea::Gga> gga;

    /// Seconds since the epoch of the fix itself, by the satellites; nothing without a date.
    std::optional<double> time() const;
    /// The receiver vouches for it.
    bool isValid() const;
    std::optional<nmea::Position> position() const;
    std::optional<nmea::UtcTime> timeOfDay() const;
};

/// Finds the sentences in the bytes of a GPS receiver and joins those that tell of the same moment. A fix is
/// complete with its second sentence, or with the one that ended the fix before, or when the next begins.
class FixTracker {
public:
    using Sink = std::function<void(const Fix &)>;

    explicit FixTracker(nmea::ChecksumRule rule)
        : parser_(rule) {}

    void feed(std::string_view bytes, const Arrival &arrival, const Sink &sink);
    /// Gives what was begun.
    void finish(const Sink &sink);
    /// Bytes are missing here.
    void skip() { parser_.reset(); }

    const nmea::SentenceParser::Counts &counts() const { return parser_.counts(); }
    /// RMC and GGA whose fields made no sense, and the last such fault.
    std::uint64_t badFields() const { return badFields_; }
    const nmea::FieldFault &lastFault() const { return lastFault_; }

private:
    enum class Kind { None, Rmc, Gga };

    void take(const nmea::Sentence &sentence, const Sink &sink);
    void add(Kind kind, const std::optional<nmea::UtcTime> &time, const Sink &sink);
    void give(const Sink &sink);

    nmea::SentenceParser parser_;
    Arrival sentenceArrival_;
    Fix fix_;
    bool given_ = true;
    Kind last_ = Kind::None;    ///< kind of the last sentence
    Kind closing_ = Kind::None; ///< that ended the fix before
    std::uint64_t badFields_ = 0;
    nmea::FieldFault lastFault_;
};

} // namespace hermes
