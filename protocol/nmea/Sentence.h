#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hermes::nmea {

/// Longest sentence from its `$` to before its line end. The standard says 82 with CR LF; receivers exceed
/// it.
constexpr std::size_t maxSentence = 256;

/// XOR of all bytes; of a sentence: of what stands between `$` and `*`.
std::uint8_t checksum(std::string_view bytes);

/// The fields of a sentence, a view of what stands between `$` and `*`: "GPRMC,214106,A".
class Sentence {
public:
    explicit Sentence(std::string_view body)
        : body_(body) {}

    std::string_view body() const { return body_; }
    /// What stands before the first comma: talker and type, "GPRMC".
    std::string_view address() const { return field(0); }
    /// The type whoever talks: "RMC" of GPRMC and of GNRMC. Empty for a proprietary sentence ($P...) and for
    /// an address that has not five characters.
    std::string_view type() const;
    /// Of this type, with so many fields behind the address or more.
    bool is(std::string_view wanted, int leastFields) const {
        return type() == wanted && fieldCount() >= leastFields;
    }
    /// The n-th field behind the address, from 1; empty when unknown or beyond the last.
    std::string_view field(int n) const;
    /// Fields behind the address.
    int fieldCount() const;

private:
    std::string_view body_;
};

/// A whole sentence in the making, with `$`, checksum, CR and LF. Never allocates.
class SentenceText {
public:
    /// address: talker and type, "GPRMC", or its beginning.
    explicit SentenceText(std::string_view address);

    /// Puts the text behind what is there.
    void append(std::string_view text);
    /// Puts a comma and the text.
    void addField(std::string_view text);
    /// Puts `*`, the checksum, CR and LF. False when the sentence is longer than maxSentence; it is then
    /// empty.
    bool finish();

    std::string_view view() const { return {text_.data(), size_}; }

private:
    std::array<char, maxSentence + 2> text_{};
    std::size_t size_ = 0;
    bool tooLong_ = false;
};

} // namespace hermes::nmea
