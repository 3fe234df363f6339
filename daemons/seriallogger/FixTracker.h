#pragma once

#include "daemons/seriallogger/FixCalendar.h"
#include "daemons/seriallogger/FixEpoch.h"
#include "protocol/nmea/SentenceParser.h"

#include <functional>

namespace hermes::seriallogger {

/// Finds the sentences in the bytes of a GPS receiver and joins those of the same time of day to one fix,
/// whatever their order. A fix is given as soon as it tells all that one of the last told; else when a
/// sentence with another time comes, or pause() says that none came. VTG, which has no time, belongs to the
/// sentences before it; after a pause in the bytes to those behind.
class FixTracker {
public:
    using Sink = std::function<void(const Fix &)>;

    struct Counts {
        std::uint64_t badFields = 0; ///< sentences whose fields made no sense
        std::uint64_t repeated = 0;  ///< sentences that came again
        std::uint64_t late = 0;      ///< sentences that told something more when their fix was given already
    };

    explicit FixTracker(nmea::ChecksumRule rule)
        : parser_(rule) {}

    void feed(std::string_view bytes, const Moment &arrival, const Sink &sink);
    /// Until when to wait for more bytes before the fix begun is given by pause(); nothing when none waits.
    std::optional<std::int64_t> waitUntilMono_ns() const;
    /// Nothing more came, or nothing more will: gives the fix begun.
    void pause(const Sink &sink);
    /// Bytes are missing here.
    void skip() { parser_.reset(); }

    const nmea::SentenceParser::Counts &sentences() const { return parser_.counts(); }
    const Counts &counts() const { return counts_; }
    /// The last of the bad fields.
    const nmea::FieldFault &lastFault() const { return lastFault_; }

private:
    void take(const nmea::Sentence &sentence, const Sink &sink);
    bool isOfTheEpochBefore(const FixReport &report) const;
    bool isOfThisEpoch(std::string_view address, const FixReport &report) const;
    bool isRepeated(std::string_view address, const FixReport &report) const;
    void begin(const Sink &sink);
    void learn();
    /// The parts told of this epoch, or known before.
    unsigned known() const;
    bool isComplete() const;
    bool waits() const { return epoch_ && !given_ && epoch_->parts() & FixEpoch::Position; }
    void give(const Sink &sink);
    std::int64_t pause_ns() const;

    nmea::SentenceParser parser_;
    Moment sentenceArrival_;
    std::optional<Moment> last_; ///< of the last bytes
    bool paused_ = true;         ///< since the last sentence of an epoch
    std::optional<FixEpoch> epoch_;
    bool given_ = false;
    std::optional<nmea::UtcTime> before_; ///< time of the epoch before
    double period_s_ = 1;                 ///< from epoch to epoch
    std::array<unsigned, 16> told_{};     ///< parts that the last epochs told; some sentences come less often
    std::size_t epochs_ = 0;
    FixCalendar calendar_;
    Counts counts_;
    nmea::FieldFault lastFault_;
};

} // namespace hermes::seriallogger
