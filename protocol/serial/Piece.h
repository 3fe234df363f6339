#pragma once

#include <QByteArray>
#include <optional>

namespace hermes {

/// What a frame holds, by its first byte: a message begins with a map or an array of CBOR.
enum class FrameKind : quint8 {
    Piece = 0x10,
    PieceToReport = 0x11, ///< the same, and its receiver reports what it has
    Report = 0x12,
    FirstOfMessages = 0x80,
    LastOfMessages = 0xbf,
};

constexpr int pieceBytes = 96;   ///< of content; of the last one of a message fewer
constexpr int windowPieces = 64; ///< from the first that is missing; none beyond is sent
constexpr int maxPieces = 0xffff;

/// A part of a large message. All numbers on the wire have their lowest byte first.
struct Piece {
    static constexpr int headerBytes = 8;

    bool toReport = false;
    quint16 number = 0; ///< of the message, one more for each
    quint16 index = 0;
    quint32 total = 0; ///< bytes of the message
    QByteArray bytes;

    int count() const { return int((total + pieceBytes - 1) / pieceBytes); }
    QByteArray toFrame() const;
    /// Nothing: there is no such piece.
    static std::optional<Piece> fromFrame(const QByteArray &frame);
};

/// What the receiver has of a message in pieces.
struct PieceReport {
    static constexpr quint16 ended = 0xffff; ///< as base: it has all, or wants none

    quint16 number = 0;
    quint16 base = 0;  ///< the first piece that is missing
    quint64 later = 0; ///< which it has of those from base, the lowest bit first

    QByteArray toFrame() const;
    static std::optional<PieceReport> fromFrame(const QByteArray &frame);
};

} // namespace hermes
