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
    if (byte == '$' || (byte == '!' && size_ == 0))
        return begin(byte);
    const bool ends = byte == '\r' || byte == '\n';
    if (size_ == 0) {
        counts_.skippedBytes += !ends;
        return Result::Incomplete;
    }
    if (ends)
        return finish();
    if (byte < ' ' || byte > '~')
        return drop(Result::BadByte, counts_.badByte);
    if (size_ == text_.size())
        return drop(Result::TooLong, counts_.tooLong);
    text_[size_++] = byte;
    return Result::Incomplete;
}

SentenceParser::Result SentenceParser::begin(char byte) {
    const Result result = size_ > 0 ? drop(Result::CutShort, counts_.cutShort) : Result::Incomplete;
    text_[0] = byte;
    size_ = 1;
    return result;
}

SentenceParser::Result SentenceParser::finish() {
    const std::string_view whole(text_.data() + 1, size_ - 1);
    const std::size_t star = whole.find('*');
    if (star == std::string_view::npos) {
        if (rule_ == ChecksumRule::Strict)
            return drop(Result::NoChecksum, counts_.noChecksum);
    } else if (whole.size() != star + 3 ||
               digitValue(whole[star + 1]) * 16 + digitValue(whole[star + 2]) !=
                   checksum(whole.substr(0, star)) ||
               digitValue(whole[star + 2]) < 0) {
        return drop(Result::BadChecksum, counts_.badChecksum);
    }
    bodySize_ = star == std::string_view::npos ? whole.size() : star;
    size_ = 0;
    ++counts_.sentences;
    return Result::Done;
}

SentenceParser::Result SentenceParser::drop(Result why, std::uint64_t &count) {
    ++count;
    size_ = 0;
    return why;
}

} // namespace hermes::nmea
