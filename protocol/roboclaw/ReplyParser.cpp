#include "protocol/roboclaw/ReplyParser.h"

#include "protocol/roboclaw/Crc16.h"

#include <algorithm>

namespace hermes::roboclaw {

namespace {

constexpr std::size_t crcSize = 2;

} // namespace

void ReplyParser::begin(const Request &request) {
    layout_ = layoutOf(std::uint8_t(request.command));
    requestCrc_ = crc16(request.bytes.data(), request.bytes.size());
    bytes_.clear();
    reply_ = Reply();
    dialect_ = Dialect::Usual;
}

ReplyParser::Result ReplyParser::feed(std::uint8_t byte) {
    if (!layout_)
        return Result::Unexpected;
    bytes_.push(byte);
    if (!layout_->isRead)
        return byte == acknowledgement ? Result::Done : Result::Unexpected;
    if (layout_->fields == "s")
        return feedText();
    const std::size_t usual = sizeOf(layout_->fields), other = sizeOf(layout_->otherFields);
    if (bytes_.size() < std::max(usual, other) + crcSize)
        return Result::Incomplete;
    return usual >= other ? finish(layout_->fields, Dialect::Usual)
                          : finish(layout_->otherFields, Dialect::Other);
}

ReplyParser::Result ReplyParser::silence() {
    if (!layout_ || !layout_->isRead || layout_->fields == layout_->otherFields)
        return Result::Incomplete;
    const std::size_t usual = sizeOf(layout_->fields), other = sizeOf(layout_->otherFields);
    if (bytes_.size() != std::min(usual, other) + crcSize)
        return Result::Incomplete;
    return usual < other ? finish(layout_->fields, Dialect::Usual)
                         : finish(layout_->otherFields, Dialect::Other);
}

ReplyParser::Result ReplyParser::feedText() {
    const std::size_t size = bytes_.size();
    if (size > crcSize && bytes_[size - crcSize - 1] == 0) { // the first NUL ends the text
        const std::size_t textSize = size - crcSize;         // with its NUL
        if (!crcFits(textSize))
            return Result::BadCrc;
        reply_.endsWithLineFeed = textSize > 1 && bytes_[textSize - 2] == '\n';
        std::copy_n(bytes_.data(), textSize - 1 - reply_.endsWithLineFeed, reply_.text.begin());
        return Result::Done;
    }
    return size < maxText + crcSize ? Result::Incomplete : Result::Unexpected;
}

ReplyParser::Result ReplyParser::finish(std::string_view fields, Dialect dialect) {
    if (!crcFits(sizeOf(fields)))
        return Result::BadCrc;
    reply_.values = unpack(fields, bytes_.data());
    dialect_ = dialect;
    return Result::Done;
}

bool ReplyParser::crcFits(std::size_t dataSize) const {
    const std::uint16_t sent = std::uint16_t(bytes_[dataSize] << 8 | bytes_[dataSize + 1]);
    return crc16(bytes_.data(), dataSize, requestCrc_) == sent;
}

} // namespace hermes::roboclaw
