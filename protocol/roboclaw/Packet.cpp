#include "protocol/roboclaw/Packet.h"

#include <algorithm>
#include <cstdlib>

namespace hermes::roboclaw {

namespace {

struct Range {
    std::int64_t least;
    std::int64_t most;
};

Range rangeOf(char field) {
    switch (field) {
    case 'B':
        return {0, UINT8_MAX};
    case 'H':
        return {0, UINT16_MAX};
    case 'h':
        return {INT16_MIN, INT16_MAX};
    case 'i':
        return {INT32_MIN, INT32_MAX};
    default:
        return {0, UINT32_MAX};
    }
}

void appendCrc(const Request &request, Bytes &reply) {
    const std::uint16_t start = crc16(request.bytes.data(), request.bytes.size());
    reply.push16(crc16(reply.data(), reply.size(), start));
}

} // namespace

bool pack(std::string_view fields, const Values &values, Bytes &bytes) {
    if (values.size() != fields.size())
        return false;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const Range range = rangeOf(fields[i]);
        if (values[i] < range.least || values[i] > range.most)
            return false;
        for (int shift = int(sizeOf(fields.substr(i, 1))) * 8 - 8; shift >= 0; shift -= 8)
            bytes.push(std::uint8_t(std::uint64_t(values[i]) >> shift));
    }
    return true;
}

Values unpack(std::string_view fields, const std::uint8_t *data) {
    Values values;
    for (const char field : fields) {
        std::uint32_t raw = 0;
        for (std::size_t left = sizeOf({&field, 1}); left > 0; --left)
            raw = raw << 8 | *data++;
        if (field == 'i')
            values.push(std::int32_t(raw));
        else if (field == 'h')
            values.push(std::int16_t(raw));
        else
            values.push(raw);
    }
    return values;
}

std::optional<Request> Request::make(std::uint8_t address, Command command, const Values &values) {
    const Layout *layout = layoutOf(std::uint8_t(command));
    if (!layout || address < firstAddress || address > lastAddress)
        return {};
    Request request{address, command, values, {}};
    request.bytes.push(address);
    request.bytes.push(std::uint8_t(command));
    std::string_view fields = layout->isRead ? layout->arguments : layout->fields;
    if (!layout->isRead && values.size() == layout->otherFields.size())
        fields = layout->otherFields;
    if (!pack(fields, values, request.bytes))
        return {};
    if (!layout->isRead)
        request.bytes.push16(crc16(request.bytes.data(), request.bytes.size()));
    return request;
}

std::optional<Bytes> encodeReply(const Request &request, const Values &values, Dialect dialect) {
    const Layout *layout = layoutOf(std::uint8_t(request.command));
    if (!layout || !layout->isRead)
        return {};
    Bytes reply;
    if (!pack(dialect == Dialect::Usual ? layout->fields : layout->otherFields, values, reply))
        return {};
    appendCrc(request, reply);
    return reply;
}

Bytes encodeText(const Request &request, std::string_view text, bool lineFeed) {
    Bytes reply;
    for (const char c : text.substr(0, maxText - 2))
        reply.push(std::uint8_t(c));
    if (lineFeed)
        reply.push('\n');
    reply.push(0);
    appendCrc(request, reply);
    return reply;
}

std::int32_t signedSpeed(const Reply &reply) {
    const auto speed = std::int32_t(reply[0]);
    const bool backward = reply[1] & 1;
    return backward ? std::int32_t(-std::abs(std::int64_t(speed))) : speed;
}

namespace {

constexpr std::size_t crcSize = 2;

} // namespace

void ReplyParser::begin(const Bytes &request) {
    layout_ = layoutOf(request[1]);
    requestCrc_ = crc16(request.data(), request.size());
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

RequestParser::Result RequestParser::feed(std::uint8_t byte) {
    bytes_.push(byte);
    const Layout *layout = bytes_.size() < 2 ? nullptr : layoutOf(bytes_[1]);
    const bool forNobody = bytes_[0] < firstAddress || bytes_[0] > lastAddress;
    if (forNobody || (bytes_.size() >= 2 && !layout)) {
        bytes_.clear();
        return Result::Unknown;
    }
    if (!layout)
        return Result::Incomplete;
    const std::string_view written = dialect_ == Dialect::Usual ? layout->fields : layout->otherFields;
    const std::string_view fields = layout->isRead ? layout->arguments : written;
    const std::size_t checkSize = layout->isRead ? 0 : 2;
    return bytes_.size() < 2 + sizeOf(fields) + checkSize ? Result::Incomplete : finish(*layout, fields);
}

RequestParser::Result RequestParser::finish(const Layout &layout, std::string_view fields) {
    const bool damaged = !layout.isRead && crc16(bytes_.data(), bytes_.size()) != 0; // its CRC makes it 0
    request_ = {bytes_[0], layout.command, unpack(fields, bytes_.data() + 2), bytes_};
    bytes_.clear();
    return damaged ? Result::BadCrc : Result::Done;
}

} // namespace hermes::roboclaw
