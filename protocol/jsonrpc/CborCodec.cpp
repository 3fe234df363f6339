#include "protocol/jsonrpc/CborCodec.h"

#include "protocol/wire/CborWriter.h"

#include <QtEndian>
#include <algorithm>

namespace hermes {
namespace {

constexpr int prefixBytes = 4;
constexpr char endOfContainer = '\xff';
constexpr char beginOfArray = '\x9f'; // both of those without a length

QByteArray prefix(qsizetype size) {
    QByteArray bytes(prefixBytes, Qt::Uninitialized);
    qToBigEndian(quint32(size), bytes.data());
    return bytes;
}

} // namespace

std::vector<CodecFrame> CborCodec::splitFrames(const QByteArray &bytes) {
    std::vector<CodecFrame> frames;
    int at = 0;
    while (at < bytes.size()) {
        const int skipped = int(std::min<quint64>(toSkip_, quint64(bytes.size() - at)));
        toSkip_ -= quint64(skipped);
        at += skipped;
        const auto take = [&](int wanted) {
            const int size = std::min(wanted - frame_.size(), bytes.size() - at);
            frame_.append(bytes.constData() + at, size);
            at += size;
            return frame_.size() == wanted;
        };
        if (frame_.size() < prefixBytes && !take(prefixBytes))
            break;
        const auto size = qFromBigEndian<quint32>(frame_.constData());
        if (size > quint32(frameLimit())) {
            frames.push_back(
                {{},
                 RpcError(ErrorCode::OverLimit, QStringLiteral("frame of %1 bytes, larger than %2, skipped")
                                                    .arg(size)
                                                    .arg(frameLimit()))});
            toSkip_ = size;
            frame_ = QByteArray();
        } else if (take(prefixBytes + int(size))) {
            frames.push_back({frame_.mid(prefixBytes), std::nullopt});
            frame_ = QByteArray();
        }
    }
    return frames;
}

void CborCodec::forgetFrame() {
    frame_.clear();
    toSkip_ = 0;
}

std::optional<WireValue> CborCodec::parse(const QByteArray &bytes, WireError *error) const {
    return WireValue::parseCbor(bytes, error);
}

QByteArray CborCodec::frame(const Outgoing &message, std::optional<QString> &path) {
    CborWriter writer;
    message.write(writer);
    if (writer.hasRefused())
        path = writer.refused();
    const QByteArray item = writer.take();
    return prefix(item.size()) + item;
}

void CborCodec::joinBatch(std::vector<QByteArray> &frames) const {
    qsizetype size = 2;
    for (QByteArray &frame : frames) {
        frame.remove(0, prefixBytes);
        size += frame.size();
    }
    frames.front().prepend(beginOfArray).prepend(prefix(size));
    frames.back().append(endOfContainer);
}

// The params come last, and have an end, as has the whole: the other two go before these ends.
QByteArray CborCodec::forSubscription(const QByteArray &notification, quint64 subscription,
                                      quint64 dropped) const {
    QByteArray more;
    QCborStreamWriter writer(&more);
    writer.append(QLatin1String("subscription"));
    writer.append(subscription);
    writer.append(QLatin1String("dropped"));
    writer.append(dropped);
    more.append(endOfContainer).append(endOfContainer);
    const int rest = notification.size() - prefixBytes - 2;
    return prefix(rest + more.size()).append(notification.constData() + prefixBytes, rest).append(more);
}

} // namespace hermes
