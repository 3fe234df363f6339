#include "protocol/roboclaw/Packet.h"

#include "protocol/roboclaw/Crc16.h"

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

} // namespace hermes::roboclaw
