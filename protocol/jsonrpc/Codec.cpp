#include "protocol/jsonrpc/Codec.h"

#include "protocol/jsonrpc/JsonCodec.h"
#include "protocol/jsonrpc/JsonText.h"

namespace hermes {
namespace {

struct Kind {
    const char *name;
    std::unique_ptr<Codec> (*make)();
};

// A new framing is one line here.
const Kind kinds[] = {
    {"json", [] { return std::unique_ptr<Codec>(new JsonCodec); }},
};

} // namespace

std::vector<CodecItem> Codec::feed(const QByteArray &bytes) {
    std::vector<CodecItem> items;
    for (const CodecFrame &frame : split(bytes)) {
        items.push_back(read(frame));
        count(items.back());
    }
    return items;
}

void Codec::count(const CodecItem &item) {
    if (!item.error)
        ++counts.messagesIn;
    else if (item.error->is(ErrorCode::OverLimit))
        ++counts.oversized;
    else
        ++counts.malformed;
}

EncodedFrame Codec::encode(const QJsonValue &message) {
    if (const auto path = findNonFinite(message)) {
        ++counts.refused;
        return {{},
                RpcError(ErrorCode::InternalError,
                         QStringLiteral("cannot send %1: not a finite number").arg(*path))};
    }
    ++counts.messagesOut;
    return {frame(message), std::nullopt};
}

std::unique_ptr<Codec> makeCodec(const QString &name) {
    for (const Kind &kind : kinds) {
        if (name == QLatin1String(kind.name))
            return kind.make();
    }
    return nullptr;
}

QStringList codecNames() {
    QStringList names;
    for (const Kind &kind : kinds)
        names.append(QLatin1String(kind.name));
    return names;
}

} // namespace hermes
