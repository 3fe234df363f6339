#include "protocol/jsonrpc/CborCodec.h"
#include "tests/fuzz/FuzzCodec.h"

#include <QtEndian>

using namespace hermes;

/// The bytes are frames, or one item in a frame of its size.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    const int limit = 1 + in.take<std::uint16_t>() % 8192, piece = 1 + in.take<std::uint8_t>() % 32;
    const bool isItem = in.take<std::uint8_t>() % 4 != 0;
    QByteArray bytes = QByteArray::fromStdString(in.bytes(size));
    if (isItem) {
        QByteArray prefix(4, Qt::Uninitialized);
        qToBigEndian(quint32(bytes.size()), prefix.data());
        bytes.prepend(prefix);
    }
    fuzzCodec<CborCodec>(bytes, limit, piece);
    return 0;
}
