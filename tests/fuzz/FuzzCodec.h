#pragma once

#include "tests/fuzz/FuzzInput.h"

#include "protocol/jsonrpc/JsonRpc.h"
#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"

namespace hermes {

inline void requireSame(const std::vector<CodecItem> &a, const std::vector<CodecItem> &b) {
    FUZZ_REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        FUZZ_REQUIRE(a[i].message == b[i].message && a[i].error.has_value() == b[i].error.has_value());
        FUZZ_REQUIRE(!a[i].error || a[i].error->message == b[i].error->message);
    }
}

/// Whatever arrives, and however it is split, gives the same items: a message or an error for each frame. A
/// message can be sent on, and is read again.
template <typename Framing>
void fuzzCodec(const QByteArray &bytes, int limit, int piece) {
    Framing whole, split;
    whole.watchForStrangers();
    split.watchForStrangers();
    whole.setFrameLimit(limit);
    split.setFrameLimit(limit);
    const std::vector<CodecItem> items = whole.feed(bytes);
    std::vector<CodecItem> pieces;
    for (int i = 0; i < bytes.size(); i += piece) {
        const auto more = split.feed(bytes.mid(i, piece));
        pieces.insert(pieces.end(), more.begin(), more.end());
    }
    FUZZ_REQUIRE(whole.greeting().speaker() == split.greeting().speaker());
    if (whole.greeting().isForeign()) { // who never ends a frame may have got an error before
        FUZZ_REQUIRE(items.empty());
        return;
    }
    requireSame(items, pieces);
    Framing peer;
    for (const CodecItem &item : items) {
        FUZZ_REQUIRE(item.message.isUndefined() == item.error.has_value());
        if (item.error)
            continue;
        ReadReport report;
        readMessage<ScanMessage>(item.data, report);
        FUZZ_REQUIRE(!readFrame(item.message).messages.empty());
        const EncodedFrame frame = peer.encode(item.message);
        FUZZ_REQUIRE(!frame.error);
        const auto back = peer.feed(frame.bytes);
        FUZZ_REQUIRE(back.size() == 1 && !back[0].error);
        requireSame(back, peer.feed(peer.encode(back[0].message).bytes));
    }
}

} // namespace hermes
