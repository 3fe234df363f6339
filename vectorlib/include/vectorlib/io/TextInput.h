#pragma once

#include "vectorlib/io/InputError.h"

#include <array>
#include <charconv>
#include <cmath>
#include <istream>
#include <optional>
#include <string_view>
#include <vector>

namespace vectorlib {

/// Lines of a text input, read in blocks; memory stays bounded whatever the input holds. CR LF counts as one
/// line end.
class LineReader {
public:
    static constexpr std::size_t maxLineLength = 1 << 20;
    static constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";

    LineReader(std::istream &in, std::string name)
        : in_(in)
        , name_(std::move(name)) {}

    /// The next line without its end; nothing at the end of the input or on an error, see error().
    std::optional<std::string_view> next() {
        line_.clear();
        terminated_ = false;
        if (error_ || (at_ == filled_ && !fill()))
            return std::nullopt;
        ++number_;
        while (!terminated_ && (at_ < filled_ || fill()))
            takeRestOfLine();
        if (error_)
            return std::nullopt;
        if (!line_.empty() && line_.back() == '\r')
            line_.pop_back();
        if (number_ == 1 && line_.rfind(byteOrderMark, 0) == 0) // as Windows begins text
            line_.erase(0, byteOrderMark.size());
        if (line_.find('\0') != std::string::npos)
            return fail("a NUL byte", "a line of text");
        return line_;
    }

    /// Set when the input is no text, has an endless line or could not be read to its end.
    const std::optional<InputError> &error() const { return error_; }
    /// Number of the line that next() gave last, from 1.
    std::size_t number() const { return number_; }
    /// False when the last line ended with the input instead of a line feed: it may be cut short.
    bool terminated() const { return terminated_; }
    const std::string &name() const { return name_; }
    /// An error at the line that was read last.
    InputError errorHere(std::string found, std::string expected) const {
        return {name_, number_, std::move(found), std::move(expected)};
    }

private:
    bool fill() {
        in_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
        at_ = 0;
        filled_ = static_cast<std::size_t>(in_.gcount());
        if (in_.bad()) {
            fail("input that ends or breaks off too early", "input that can be read to its end");
            return false;
        }
        return filled_ > 0;
    }
    void takeRestOfLine() {
        const std::string_view rest(block_.data() + at_, filled_ - at_);
        const std::size_t length = std::min(rest.find('\n'), rest.size());
        line_.append(rest.substr(0, length));
        terminated_ = length < rest.size();
        at_ += length + (terminated_ ? 1 : 0);
        if (line_.size() > maxLineLength)
            fail("a line of over " + std::to_string(maxLineLength) + " characters", "lines of text");
        if (error_)
            terminated_ = true;
    }
    std::nullopt_t fail(std::string found, std::string expected) {
        error_ = errorHere(std::move(found), std::move(expected));
        return std::nullopt;
    }

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
inline std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isBlank(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && isBlank(text.back()))
        text.remove_suffix(1);
    return text;
}

/// A finite number that fills the whole field, in the notation of C whatever the locale; else nothing.
inline std::optional<double> parseNumber(std::string_view text) {
    text = trimmed(text);
    if (text.size() > 1 && text[0] == '+' && text[1] != '-')
        text.remove_prefix(1);
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

/// A non-negative whole number up to `limit`; else nothing.
inline std::optional<std::size_t> parseCount(std::string_view text, std::size_t limit) {
    text = trimmed(text);
    std::size_t value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size() || value > limit)
        return std::nullopt;
    return value;
}

/// The fields of a line that blanks separate, into `fields` (reused).
inline void splitBlanks(std::string_view line, std::vector<std::string_view> &fields) {
    fields.clear();
    for (std::size_t at = 0; at < line.size();) {
        if (isBlank(line[at])) {
            ++at;
            continue;
        }
        const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
        fields.push_back(line.substr(at, end - at));
        at = end;
    }
}

/// The fields of a line that commas separate, blanks around them removed, into `fields` (reused).
inline void splitCommas(std::string_view line, std::vector<std::string_view> &fields) {
    fields.clear();
    for (std::size_t at = 0;;) {
        const std::size_t end = std::min(line.find(',', at), line.size());
        fields.push_back(trimmed(line.substr(at, end - at)));
        if (end == line.size())
            return;
        at = end + 1;
    }
}

/// Text of an input for a message: in quotes, at most 40 characters, nothing unprintable.
inline std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text.substr(0, 40))
        out += c >= ' ' && c <= '~' ? c : '?';
    return out + (text.size() > 40 ? "...\"" : "\"");
}

} // namespace vectorlib
