#include "tests/fuzz/FuzzInput.h"

#include "protocol/nmea/Gga.h"
#include "protocol/nmea/Gll.h"
#include "protocol/nmea/Gns.h"
#include "protocol/nmea/Rmc.h"
#include "protocol/nmea/SentenceParser.h"
#include "protocol/nmea/Vtg.h"
#include "protocol/nmea/Zda.h"

using namespace hermes::nmea;

namespace {

void requireSound(const std::optional<Position> &position) {
    FUZZ_REQUIRE(!position ||
                 (std::abs(position->latitude_deg) <= 90 && std::abs(position->longitude_deg) <= 180));
}

/// What is only read.
void requireWithinLimits(const Sentence &sentence) {
    Gll gll;
    if (!decode(sentence, gll))
        requireSound(gll.position);
    Gns gns;
    if (!decode(sentence, gns)) {
        requireSound(gns.position);
        FUZZ_REQUIRE(!gns.quality || (*gns.quality >= 0 && *gns.quality <= 8));
        FUZZ_REQUIRE(!gns.altitude || std::abs(*gns.altitude) <= maxMetres);
    }
    Vtg vtg;
    if (!decode(sentence, vtg)) {
        FUZZ_REQUIRE(!vtg.speed || (*vtg.speed >= 0 && *vtg.speed < 1e4));
        FUZZ_REQUIRE(!vtg.course_deg || (*vtg.course_deg >= 0 && *vtg.course_deg <= 360));
    }
    Zda zda;
    if (!decode(sentence, zda))
        FUZZ_REQUIRE(!zda.date || isValid(*zda.date));
}

/// What was read can be written, and reads back as the same.
template <typename Message>
void requireReadable(const Message &message, const Decimals &decimals) {
    requireSound(message.position);
    const auto text = encode(message, "GN", decimals);
    if (!text) // a year, or numbers too long for one sentence
        return;
    SentenceParser parser;
    auto result = SentenceParser::Result::Incomplete;
    for (const char byte : text->view()) {
        result = parser.feed(byte);
        if (result != SentenceParser::Result::Incomplete)
            break;
    }
    FUZZ_REQUIRE(result == SentenceParser::Result::Done);
    Message again;
    FUZZ_REQUIRE(!decode(parser.sentence(), again));
    FUZZ_REQUIRE(again.position.has_value() == message.position.has_value());
    FUZZ_REQUIRE(again.time.has_value() == message.time.has_value());
    const auto twice = encode(again, "GN", decimals);
    FUZZ_REQUIRE(twice && twice->view().size() <= text->view().size() + 1);
}

} // namespace

/// Any bytes: each sentence begun ends once, what is read is within its limits and can be written again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    SentenceParser parser(in.flag() ? ChecksumRule::Strict : ChecksumRule::Lenient);
    const Decimals decimals{in.take<std::uint8_t>() % 10, in.take<std::uint8_t>() % 10};
    std::uint64_t ended = 0;
    for (const char byte : in.bytes(size)) {
        ended += parser.feed(byte) != SentenceParser::Result::Incomplete;
        FUZZ_REQUIRE(parser.pending() <= maxSentence);
        if (parser.counts().sentences == 0 || parser.pending() > 0)
            continue;
        Rmc rmc;
        if (!decode(parser.sentence(), rmc))
            requireReadable(rmc, decimals);
        Gga gga;
        if (!decode(parser.sentence(), gga))
            requireReadable(gga, decimals);
        requireWithinLimits(parser.sentence());
    }
    const SentenceParser::Counts &counts = parser.counts();
    FUZZ_REQUIRE(ended == counts.sentences + counts.badChecksum + counts.noChecksum + counts.tooLong +
                              counts.badByte + counts.cutShort);
    return 0;
}
