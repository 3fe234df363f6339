#include "protocol/jsonrpc/JsonCodec.h"

#include "protocol/wire/JsonTextWriter.h"

#include <cstring>

namespace hermes {

std::vector<CodecFrame> JsonCodec::splitFrames(const QByteArray &bytes) {
    std::vector<CodecFrame> frames;
    const char *position = bytes.constData();
    const char *const end = position + bytes.size();
    while (position < end) {
        const auto *lineFeed = static_cast<const char *>(std::memchr(position, '\n', size_t(end - position)));
        append(position, int((lineFeed ? lineFeed : end) - position), frames);
        if (!lineFeed)
            break;
        finishLine(frames);
        position = lineFeed + 1;
    }
    return frames;
}

void JsonCodec::append(const char *bytes, int size, std::vector<CodecFrame> &frames) {
    if (skipping_)
        return;
    // One byte more than the limit may wait: the CR of a CR LF.
    if (line_.size() + size > frameLimit() + 1) {
        skipping_ = true;
        line_ = QByteArray();
        frames.push_back({{},
                          RpcError(ErrorCode::OverLimit,
                                   QStringLiteral("line larger than %1 bytes, skipped").arg(frameLimit()))});
        return;
    }
    line_.append(bytes, size);
}

void JsonCodec::finishLine(std::vector<CodecFrame> &frames) {
    if (skipping_) {
        skipping_ = false;
        return;
    }
    if (line_.endsWith('\r'))
        line_.chop(1);
    if (line_.size() > frameLimit()) {
        append("xx", 2, frames); // reaches the limit and reports it
        skipping_ = false;
        return;
    }
    if (!line_.trimmed().isEmpty())
        frames.push_back({line_, std::nullopt});
    line_ = QByteArray();
}

std::optional<WireValue> JsonCodec::parse(const QByteArray &bytes, WireError *error) const {
    return WireValue::parse(bytes, error, limits());
}

void JsonCodec::forgetFrame() {
    line_.clear();
    skipping_ = false;
}

void JsonCodec::joinBatch(std::vector<QByteArray> &frames) const {
    for (QByteArray &frame : frames)
        frame[frame.size() - 1] = ','; // was the line feed
    frames.front().prepend('[');
    frames.back().chop(1);
    frames.back().append("]\n");
}

QByteArray JsonCodec::forSubscription(const QByteArray &notification, quint64 subscription,
                                      quint64 dropped) const {
    static const QByteArray end = QByteArrayLiteral("}}\n"); // params are its last member
    QByteArray frame;
    frame.reserve(notification.size() + 64);
    frame.append(notification.constData(), notification.size() - end.size());
    frame.append(",\"subscription\":").append(QByteArray::number(subscription));
    return frame.append(",\"dropped\":").append(QByteArray::number(dropped)).append(end);
}

QByteArray JsonCodec::frame(const Outgoing &message, std::optional<QString> &path) {
    JsonTextWriter writer;
    message.write(writer);
    if (writer.hasRefused())
        path = writer.refused();
    return writer.take().append('\n');
}

} // namespace hermes
