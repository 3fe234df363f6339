#include "vectorlib/io/TextInput.h"

#include <charconv>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY Utf8Character nextCharacter(const std::string &text, std::size_t at) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(at);
    if (first < 0x80)
        return {first, 1};
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || at + length > text.size())
        return {};
    char32_t code = first & (0x7fu >> length);
    for (std::size_t i = at + 1; i < at + length; ++i) {
        if ((byte(i) & 0xc0) != 0x80)
            return {};
        code = code << 6 | (byte(i) & 0x3fu);
    }
    constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool isSurrogate = code >= 0xd800 && code <= 0xdfff;
    return code < least[length] || isSurrogate || code > 0x10ffff ? Utf8Character()
                                                                  : Utf8Character{code, length};
}

VECTORLIB_BODY std::optional<std::string_view> LineReader::next() {
    line_.clear();
    terminated_ = false;
    if (error_ || (at_ == filled_ && !fill()))
        return std::nullopt;
    ++number_;
    while (!terminated_ && (at_ < filled_ || fill()))
        takeRestOfLine();
    if (error_)
        return std::nullopt;
    if (number_ == 1 && line_.rfind(byteOrderMark, 0) == 0) // as Windows begins text
        line_.erase(0, byteOrderMark.size());
    if (line_.find('\0') != std::string::npos)
        return fail("a NUL byte", "a line of text");
    return line_;
}

VECTORLIB_BODY bool LineReader::fill() {
    in_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
    at_ = 0;
    filled_ = static_cast<std::size_t>(in_.gcount());
    if (in_.bad()) {
        fail("input that ends or breaks off too early", "input that can be read to its end");
        return false;
    }
    return filled_ > 0;
}

VECTORLIB_BODY void LineReader::takeRestOfLine() {
    const std::string_view rest(block_.data() + at_, filled_ - at_);
    const std::string_view line = rest.substr(0, rest.find('\n'));
    const std::size_t length = std::min(line.find('\r'), line.size());
    line_.append(rest.substr(0, length));
    terminated_ = length < rest.size();
    at_ += length + (terminated_ ? 1 : 0);
    if (length < line.size() && (at_ < filled_ || fill()) && block_[at_] == '\n')
        ++at_; // CR LF is one line end
    if (line_.size() > maxLineLength)
        fail("a line of over " + std::to_string(maxLineLength) + " characters", "lines of text");
    if (error_)
        terminated_ = true;
}

VECTORLIB_BODY std::nullopt_t LineReader::fail(std::string found, std::string expected) {
    error_ = errorHere(std::move(found), std::move(expected));
    return std::nullopt;
}

VECTORLIB_BODY std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isBlank(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && isBlank(text.back()))
        text.remove_suffix(1);
    return text;
}

VECTORLIB_BODY std::optional<double> parseAnyNumber(std::string_view text) {
    text = trimmed(text);
    if (text.size() > 1 && text[0] == '+' && text[1] != '-')
        text.remove_prefix(1);
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size())
        return std::nullopt;
    return value;
}

VECTORLIB_BODY std::optional<double> parseNumber(std::string_view text) {
    const auto value = parseAnyNumber(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

VECTORLIB_BODY std::optional<std::size_t> parseCount(std::string_view text, std::size_t limit) {
    text = trimmed(text);
    std::size_t value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size() || value > limit)
        return std::nullopt;
    return value;
}

VECTORLIB_BODY void splitBlanks(std::string_view line, std::vector<std::string_view> &fields) {
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

VECTORLIB_BODY void splitCommas(std::string_view line, std::vector<std::string_view> &fields) {
    fields.clear();
    for (std::size_t at = 0;;) {
        const std::size_t end = std::min(line.find(',', at), line.size());
        fields.push_back(trimmed(line.substr(at, end - at)));
        if (end == line.size())
            return;
        at = end + 1;
    }
}

VECTORLIB_BODY std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text.substr(0, 40))
        out += c >= ' ' && c <= '~' ? c : '?';
    return out + (text.size() > 40 ? "...\"" : "\"");
}

} // namespace vectorlib
