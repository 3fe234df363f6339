#include "protocol/jsonrpc/JsonCodec.h"
#include "tests/fuzz/FuzzCodec.h"

using namespace hermes;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    const int limit = 1 + in.take<std::uint16_t>() % 1024, piece = 1 + in.take<std::uint8_t>() % 32;
    fuzzCodec<JsonCodec>(QByteArray::fromStdString(in.bytes(size)), limit, piece);
    return 0;
}
