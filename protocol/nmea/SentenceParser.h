#pragma once

#include "protocol/nmea/Sentence.h"

namespace hermes::nmea {

/// What to do with a sentence without checksum, as the old standard allows it. A wrong one is never accepted.
enum class ChecksumRule {
    Strict,  ///< refused
    Lenient, ///< accepted
};

/// Finds the sentences in a stream of bytes, byte for byte, and is in step again at the next `$` whatever
/// came before. A checksum ends a sentence, when no more of a text follows; without one a line end does. What
/// does not begin with an address, as binary messages between sentences, is skipped, not refused. Never
/// allocates.
class SentenceParser {
public:
    enum class Result {
        Incomplete,
        Done,        ///< sentence() holds it until the next feed()
        BadChecksum, ///< damaged, or what follows `*` is not two hexadecimal digits
        NoChecksum,  ///< under the strict rule
        TooLong,     ///< more than maxSentence characters; the rest is skipped
        BadByte,     ///< a byte that is not printable ASCII; the rest is skipped
        CutShort,    ///< a `$` before the line end; a new sentence has begun with it
    };

    /// Since the parser was made.
    struct Counts {
        std::uint64_t sentences = 0; ///< Done
        std::uint64_t badChecksum = 0;
        std::uint64_t noChecksum = 0;
        std::uint64_t tooLong = 0;
        std::uint64_t badByte = 0;
        std::uint64_t cutShort = 0;
        std::uint64_t skippedBytes = 0; ///< outside of sentences, without CR, LF and blanks
    };

    explicit SentenceParser(ChecksumRule rule = ChecksumRule::Strict)
        : rule_(rule) {}

    Result feed(char byte);
    /// What was fed came at once, as a datagram: a right checksum at its end ends the sentence.
    Result endPiece();
    /// Forgets the sentence begun, as after a line was opened anew.
    void reset() { size_ = 0; }

    /// Without the start and the checksum.
    Sentence sentence() const { return Sentence({text_.data() + 1, bodySize_}); }
    /// `$`, or `!` for an encapsulated sentence (AIS).
    char start() const { return text_[0]; }
    /// Characters of the sentence begun; 1 just after its start.
    std::size_t pending() const { return size_; }
    const Counts &counts() const { return counts_; }

private:
    Result begin(char byte);
    Result finish();
    bool hasAddress() const;
    bool hasChecksum() const;
    Result drop(Result why, std::uint64_t &count, bool isSentence);

    ChecksumRule rule_;
    std::array<char, maxSentence> text_{};
    std::size_t size_ = 0; ///< 0: outside of a sentence
    std::size_t bodySize_ = 0;
    Counts counts_;
};

} // namespace hermes::nmea
