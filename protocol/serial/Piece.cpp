#include "protocol/serial/Piece.h"

#include <QtEndian>

namespace hermes {
namespace {

void append(QByteArray &frame, quint64 value, int bytes) {
    for (; bytes > 0; --bytes, value >>= 8)
        frame.append(char(value & 0xff));
}

quint64 number(const QByteArray &frame, int at, int bytes) {
    quint64 value = 0;
    for (int i = bytes - 1; i >= 0; --i)
        value = value << 8 | quint8(frame[at + i]);
    return value;
}

constexpr int reportHeaderBytes = 5;

} // namespace

QByteArray Piece::toFrame() const {
    QByteArray frame;
    frame.reserve(headerBytes + bytes.size() + 4); // and its CRC
    frame.append(char(toReport ? FrameKind::PieceToReport : FrameKind::Piece));
    append(frame, number, 2);
    append(frame, index, 2);
    append(frame, total, 3);
    return frame.append(bytes);
}

std::optional<Piece> Piece::fromFrame(const QByteArray &frame) {
    if (frame.size() < headerBytes)
        return std::nullopt;
    Piece piece;
    piece.toReport = quint8(frame[0]) == quint8(FrameKind::PieceToReport);
    piece.number = quint16(hermes::number(frame, 1, 2));
    piece.index = quint16(hermes::number(frame, 3, 2));
    piece.total = quint32(hermes::number(frame, 5, 3));
    const int count = piece.count();
    if (count > maxPieces || piece.index >= count)
        return std::nullopt;
    const int size = piece.index + 1 < count ? pieceBytes : int(piece.total) - piece.index * pieceBytes;
    if (frame.size() != headerBytes + size)
        return std::nullopt;
    piece.bytes = frame.mid(headerBytes);
    return piece;
}

QByteArray PieceReport::toFrame() const {
    QByteArray frame(1, char(FrameKind::Report));
    append(frame, number, 2);
    append(frame, base, 2);
    for (quint64 rest = later; rest != 0; rest >>= 8)
        append(frame, rest & 0xff, 1);
    return frame;
}

std::optional<PieceReport> PieceReport::fromFrame(const QByteArray &frame) {
    const int more = frame.size() - reportHeaderBytes;
    if (more < 0 || more > windowPieces / 8)
        return std::nullopt;
    return PieceReport{quint16(hermes::number(frame, 1, 2)), quint16(hermes::number(frame, 3, 2)),
                       hermes::number(frame, reportHeaderBytes, more)};
}

} // namespace hermes
