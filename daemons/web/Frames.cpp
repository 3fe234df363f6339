#include "daemons/web/Frames.h"

#include <QtEndian>
#include <algorithm>

namespace hermes::web {
namespace {

constexpr char messageOpcode = 1, callOpcode = 2, answerOpcode = 3;
constexpr int messageHead = 5, callHead = 13; // bytes before the content

template <typename T>
QByteArray littleEndian(T value) {
    QByteArray bytes(sizeof value, 0);
    qToLittleEndian(value, bytes.data());
    return bytes;
}

quint32 wordAt(const QByteArray &bytes, int offset) {
    return qFromLittleEndian<quint32>(bytes.constData() + offset);
}

} // namespace

ClientFrame ClientFrame::parse(const QByteArray &bytes) {
    if (bytes.size() >= messageHead && bytes[0] == messageOpcode)
        return {Kind::Message, wordAt(bytes, 1), 0, {}, bytes.mid(messageHead)};
    if (bytes.size() < callHead || bytes[0] != callOpcode)
        return {};
    const quint32 encoding = wordAt(bytes, 9);
    if (encoding > quint32(bytes.size() - callHead))
        return {};
    return {Kind::Call, wordAt(bytes, 1), wordAt(bytes, 5), bytes.mid(callHead, int(encoding)),
            bytes.mid(callHead + int(encoding))};
}

QByteArray messageFrame(quint32 id, double stamp, const QByteArray &json) {
    const auto ns = quint64(std::clamp(stamp, 0.0, 9e9) * 1e9);
    return messageOpcode + littleEndian(id) + littleEndian(ns) + json;
}

QByteArray answerFrame(quint32 service, quint32 call, const QByteArray &json) {
    return answerOpcode + littleEndian(service) + littleEndian(call) + littleEndian(quint32(4)) + "json" +
           json;
}

} // namespace hermes::web
