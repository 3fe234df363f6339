#include "protocol/roboclaw/RequestParser.h"

#include "protocol/roboclaw/Crc16.h"

namespace hermes::roboclaw {

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
