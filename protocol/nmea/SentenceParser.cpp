#include "protocol/nmea/SentenceParser.h"

namespace hermes::nmea {

namespace {

/// The value of a hexadecimal digit of either case, or -1.
int digitValue(char digit) {
    if (digit >= '0' && digit <= '9')
        return digit - '0';
    if (digit >= 'A' && digit <= 'F')
        return digit - 'A' + 10;
    return digit >= 'a' && digit <= 'f' ? digit - 'a' + 10 : -1;
}

} // namespace

SentenceParser::Result SentenceParser::feed(char byte) {
    const bool isGraphic = byte > ' ' && byte <= '~' && byte != '$' && byte != '!';
    if (hasChecksum() && !isGraphic) {
        const Result result = finish();
        size_ = byte == '$' || byte == '!';
        text_[0] = size_ > 0 ? byte : text_[0];
        return result;
    }
    if (byte == '$' || (byte == '!' && size_ == 0))
        return begin(byte);
    const bool ends = byte == '\r' || byte == '\n';
    if (size_ == 0) {
        counts_.skippedBytes += !ends && byte != ' ';
        return Result::Incomplete;
    }
    if (ends)
        return finish();
    if (byte < ' ' || byte > '~')
        return drop(Result::BadByte, counts_.badByte, hasAddress());
    if (size_ == text_.size())
        return drop(Result::TooLong, counts_.tooLong, hasAddress());
    text_[size_++] = byte;
    return Result::Incomplete;
}

SentenceParser::Result SentenceParser::endPiece() {
    const std::uint8_t sum = hasChecksum() ? checksum({text_.data() + 1, size_ - 4}) : 0;
    const bool isWhole = hasChecksum() && digitValue(text_[size_ - 1]) == (sum & 15) &&
                         digitValue(text_[size_ - 2]) == sum >> 4;
    return isWhole ? finish() : Result::Incomplete;
}

bool SentenceParser::hasChecksum() const {
    return size_ > 3 && text_[size_ - 3] == '*';
}

SentenceParser::Result SentenceParser::begin(char byte) {
    const Result result =
        size_ > 0 ? drop(Result::CutShort, counts_.cutShort, hasAddress()) : Result::Incomplete;
    text_[0] = byte;
    size_ = 1;
    return result;
}

SentenceParser::Result SentenceParser::finish() {
    const std::string_view whole(text_.data() + 1, size_ - 1);
    const std::size_t star = whole.find('*');
    if (star == std::string_view::npos) {
        if (rule_ == ChecksumRule::Strict)
            return drop(Result::NoChecksum, counts_.noChecksum, hasAddress());
    } else if (whole.size() != star + 3 ||
               digitValue(whole[star + 1]) * 16 + digitValue(whole[star + 2]) !=
                   checksum(whole.substr(0, star)) ||
               digitValue(whole[star + 2]) < 0) {
        return drop(Result::BadChecksum, counts_.badChecksum, whole.find(',') < star);
    }
    bodySize_ = star == std::string_view::npos ? whole.size() : star;
    size_ = 0;
    ++counts_.sentences;
    return Result::Done;
}

/// Four or more capital letters and digits before a comma: binary bytes hardly ever are so.
bool SentenceParser::hasAddress() const {
    constexpr std::size_t least = 4;
    const std::string_view text(text_.data() + 1, size_ - 1);
    const std::size_t end = text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789");
    return end != std::string_view::npos && end >= least && text[end] == ',';
}

SentenceParser::Result SentenceParser::drop(Result why, std::uint64_t &count, bool isSentence) {
    if (isSentence)
        ++count;
    else
        counts_.skippedBytes += size_;
    size_ = 0;
    return isSentence ? why : Result::Incomplete;
}

} // namespace hermes::nmea
