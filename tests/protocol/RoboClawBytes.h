#pragma once

#include "protocol/roboclaw/Packet.h"

namespace hermes::roboclaw {

/// As in the tables of the tests: upper-case hexadecimal, a space between bytes.
inline QByteArray text(const Bytes &bytes) {
    return QByteArray(reinterpret_cast<const char *>(bytes.data()), int(bytes.size())).toHex(' ').toUpper();
}

/// The result of the last byte; every byte before it must leave the parser waiting.
inline ReplyParser::Result feed(ReplyParser &parser, const QByteArray &bytes) {
    auto result = ReplyParser::Result::Incomplete;
    for (const char byte : bytes) {
        if (result != ReplyParser::Result::Incomplete)
            qFatal("the answer ended before its last byte");
        result = parser.feed(std::uint8_t(byte));
    }
    return result;
}

inline bool same(const Values &a, const Values &b) {
    bool equal = a.size() == b.size();
    for (std::size_t i = 0; equal && i < a.size(); ++i)
        equal = a[i] == b[i];
    return equal;
}

} // namespace hermes::roboclaw
