#include "protocol/jsonrpc/JsonCodec.h"

#include "protocol/jsonrpc/JsonText.h"

#include <cstring>

namespace hermes {

std::vector<CodecItem> JsonCodec::feed(const QByteArray &bytes) {
    std::vector<CodecItem> items;
    const char *position = bytes.constData();
    const char *const end = position + bytes.size();
    while (position < end) {
        const auto *lineFeed = static_cast<const char *>(std::memchr(position, '\n', size_t(end - position)));
        append(position, int((lineFeed ? lineFeed : end) - position), items);
        if (!lineFeed)
            break;
        finishLine(items);
        position = lineFeed + 1;
    }
    return items;
}

void JsonCodec::append(const char *bytes, int size, std::vector<CodecItem> &items) {
    if (skipping)
        return;
    // One byte more than the limit may wait: the CR of a CR LF.
    if (line.size() + size > frameLimit() + 1) {
        ++counts.oversized;
        skipping = true;
        line = QByteArray();
        items.push_back({QJsonValue::Undefined,
                         RpcError(ErrorCode::OverLimit,
                                  QStringLiteral("line larger than %1 bytes, skipped").arg(frameLimit()))});
        return;
    }
    line.append(bytes, size);
}

void JsonCodec::finishLine(std::vector<CodecItem> &items) {
    if (skipping) {
        skipping = false;
        return;
    }
    if (line.endsWith('\r'))
        line.chop(1);
    if (line.size() > frameLimit()) {
        append("xx", 2, items); // reaches the limit and reports it
        skipping = false;
        return;
    }
    if (line.trimmed().isEmpty()) {
        line.clear();
        return;
    }
    JsonTextError error;
    if (const auto value = parseJson(line, &error)) {
        ++counts.messagesIn;
        items.push_back({*value, std::nullopt});
    } else {
        ++counts.malformed;
        items.push_back(
            {QJsonValue::Undefined,
             RpcError(ErrorCode::ParseError,
                      QStringLiteral("parse error at byte %1: %2").arg(error.offset).arg(error.message))});
    }
    line.clear();
}

void JsonCodec::reset() {
    line.clear();
    skipping = false;
}

QByteArray JsonCodec::frame(const QJsonValue &message) {
    return compactJson(message) + '\n';
}

} // namespace hermes
