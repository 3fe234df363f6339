#include "tests/fuzz/FuzzInput.h"

#include "protocol/jsonrpc/JsonCodec.h"
#include "protocol/jsonrpc/JsonRpc.h"

using namespace hermes;

namespace {

void requireSame(const std::vector<CodecItem> &a, const std::vector<CodecItem> &b) {
    FUZZ_REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        FUZZ_REQUIRE(a[i].message == b[i].message && a[i].error.has_value() == b[i].error.has_value());
        FUZZ_REQUIRE(!a[i].error || a[i].error->message == b[i].error->message);
    }
}

} // namespace

/// Whatever arrives, and however it is split, gives the same items: a message or an error for each line. A
/// message can be sent on, and is read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    const int limit = 1 + in.take<std::uint16_t>() % 1024, piece = 1 + in.take<std::uint8_t>() % 32;
    const QByteArray text = QByteArray::fromStdString(in.bytes(size));
    JsonCodec whole, split;
    whole.setFrameLimit(limit);
    split.setFrameLimit(limit);
    const std::vector<CodecItem> items = whole.feed(text);
    std::vector<CodecItem> pieces;
    for (int i = 0; i < text.size(); i += piece) {
        const auto more = split.feed(text.mid(i, piece));
        pieces.insert(pieces.end(), more.begin(), more.end());
    }
    FUZZ_REQUIRE(whole.greeting().speaker() == split.greeting().speaker());
    if (whole.greeting().isForeign()) { // who never ends a line may have got an error before
        FUZZ_REQUIRE(items.empty());
        return 0;
    }
    requireSame(items, pieces);
    JsonCodec peer;
    for (const CodecItem &item : items) {
        FUZZ_REQUIRE(item.message.isUndefined() == item.error.has_value());
        if (item.error)
            continue;
        FUZZ_REQUIRE(!readFrame(item.message).messages.empty());
        const EncodedFrame frame = peer.encode(item.message);
        FUZZ_REQUIRE(!frame.error);
        const auto back = peer.feed(frame.bytes);
        FUZZ_REQUIRE(back.size() == 1 && !back[0].error);
        requireSame(back, peer.feed(peer.encode(back[0].message).bytes));
    }
    return 0;
}
