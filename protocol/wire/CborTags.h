#pragma once

#include "protocol/wire/WireTree.h"

namespace hermes {

/// The tag of a typed array of this kind in the byte order of this machine (RFC 8746, 2.1).
constexpr quint64 typedArrayTag(PackedNumbers::Kind kind) {
    constexpr quint64 bigEndian[] = {64, 65, 66, 67, 72, 73, 74, 75, 81, 82};
    const bool hasOrder = kind != PackedNumbers::Kind::UInt8 && kind != PackedNumbers::Kind::Int8;
    return bigEndian[int(kind)] + (hasOrder && Q_BYTE_ORDER == Q_LITTLE_ENDIAN ? 4 : 0);
}

} // namespace hermes
