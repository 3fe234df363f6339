#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/error/Result.h"

#include <array>
#include <cstddef>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vectorlib {

/// Why an input could not be read: where it is, what was found there and what was expected instead.
struct InputError {
    std::string file;     ///< name of the input as the caller gave it
    std::size_t line = 0; ///< counted from 1; 0 when the input as a whole is meant
    std::string found;
    std::string expected;

    /// `room.csv:12: found "nan", expected a finite number`
    std::string message() const {
        const std::string place = line > 0 ? file + ":" + std::to_string(line) : file;
        return place + ": found " + found + ", expected " + expected;
    }
};

/// What was read, or why it could not be read.
template <typename T>
using Expected = Result<T, InputError>;

/// A character of a text in UTF-8, and how many bytes it takes: 1 where it is none.
struct Utf8Character {
    char32_t code = 0;
    std::size_t length = 1;
    bool isValid() const { return code != 0; }
};

/// The character that begins at a byte of the text. No such character are bytes that are cut short or stand
/// alone, longer forms than needed, surrogates, and what lies beyond Unicode.
Utf8Character nextCharacter(const std::string &text, std::size_t at);

/// Lines of a text input, read in blocks; memory stays bounded whatever the input holds. LF, CR LF and CR are
/// line ends.
class LineReader {
public:
    static constexpr std::size_t maxLineLength = 1 << 20;
    static constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";

    LineReader(std::istream &in, std::string name)
        : in_(in)
        , name_(std::move(name)) {}

    /// The next line without its end; nothing at the end of the input or on an error, see error().
    std::optional<std::string_view> next();

    /// Set when the input is no text, has an endless line or could not be read to its end.
    const std::optional<InputError> &error() const { return error_; }
    /// Number of the line that next() gave last, from 1.
    std::size_t number() const { return number_; }
    /// False when the last line ended with the input instead of a line end: it may be cut short.
    bool terminated() const { return terminated_; }
    const std::string &name() const { return name_; }
    /// An error at the line that was read last.
    InputError errorHere(std::string found, std::string expected) const {
        return {name_, number_, std::move(found), std::move(expected)};
    }

private:
    bool fill();
    void takeRestOfLine();
    std::nullopt_t fail(std::string found, std::string expected);

    std::istream &in_;
    std::string name_;
    std::string line_;
    std::array<char, 1 << 16> block_;
    std::size_t at_ = 0;
    std::size_t filled_ = 0;
    std::size_t number_ = 0;
    bool terminated_ = false;
    std::optional<InputError> error_;
};

/// Whether a character is a space or a tab.
inline bool isBlank(char c) {
    return c == ' ' || c == '\t';
}

/// The text without the blanks at its ends.
std::string_view trimmed(std::string_view text);

/// A number that fills the whole field, in the notation of C whatever the locale, inf and nan among them;
/// else nothing.
std::optional<double> parseAnyNumber(std::string_view text);

/// The same of finite numbers only.
std::optional<double> parseNumber(std::string_view text);

/// A non-negative whole number up to `limit`; else nothing.
std::optional<std::size_t> parseCount(std::string_view text, std::size_t limit);

/// The fields of a line that blanks separate, into `fields` (reused).
void splitBlanks(std::string_view line, std::vector<std::string_view> &fields);

/// The fields of a line that commas separate, blanks around them removed, into `fields` (reused).
void splitCommas(std::string_view line, std::vector<std::string_view> &fields);

/// Text of an input for a message: in quotes, at most 40 characters, nothing unprintable.
std::string quoted(std::string_view text);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/TextInput.cpp")
