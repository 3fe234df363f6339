#include "protocol/jsonrpc/CborCodec.h"

#include <QtEndian>
#include <algorithm>

namespace hermes {
namespace {

constexpr int prefixBytes = 4;

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
                 RpcError(
                     ErrorCode::OverLimit,
                     QString("frame of %1 bytes, larger than %2, skipped").arg(size).arg(frameLimit()))});
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

QByteArray CborCodec::frame(const Outgoing &message, std::optional<QString> &path) {
    const QByteArray item = written(message, path);
    return prefix(item.size()) + item;
}

void CborCodec::joinBatch(std::vector<QByteArray> &frames) const {
    for (QByteArray &frame : frames)
        frame.remove(0, prefixBytes);
    joinItems(frames);
    qsizetype size = 0;
    for (const QByteArray &item : frames)
        size += item.size();
    frames.front().prepend(prefix(size));
}

QByteArray CborCodec::forSubscription(const QByteArray &notification, quint64 subscription,
                                      quint64 dropped) const {
    const QByteArray item = withSubscription(notification.mid(prefixBytes), subscription, dropped);
    return prefix(item.size()) + item;
}

} // namespace hermes
