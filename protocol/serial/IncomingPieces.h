#pragma once

#include "protocol/serial/Piece.h"

#include <deque>
#include <list>

namespace hermes {

/// Large messages on their way in, put together from their pieces in any order. Holds what has come, never
/// what was only announced; at most maxMessages, and three times the limit of one. Beyond that, and after
/// longestPause_s without a piece, the one that got none for the longest time is forgotten.
class IncomingPieces {
public:
    static constexpr std::size_t maxMessages = 8;
    static constexpr double longestPause_s = 30;

    enum class Outcome {
        Kept,
        Complete, ///< content is the message
        Duplicate,
        Stray,   ///< of a message whose beginning went to somebody else
        TooLarge ///< the first of a message over the limit
    };

    Outcome take(const Piece &piece, int limit, double now, QByteArray &content);
    bool isReportDue() const { return !due_.empty(); }
    PieceReport takeReport();
    void forgetOld(double now);
    bool isEmpty() const { return messages_.empty(); }
    void clear();
    qint64 bytes() const { return bytes_; } ///< that it holds
    quint64 forgotten() const { return forgotten_; }

private:
    struct Message {
        Message(quint16 numberOf, quint32 totalBytes)
            : number(numberOf)
            , total(totalBytes) {}

        quint16 number;
        quint32 total;
        int base = 0;      // all before have come
        quint64 later = 0; // those from base, as in a report
        QByteArray bytes;
        double touched = 0;
    };
    struct Ended {
        quint16 number;
        quint32 total;
        double at;
    };
    using Place = std::list<Message>::iterator;

    Place find(const Piece &piece);
    Place begin(const Piece &piece);
    Outcome keep(Place place, const Piece &piece, double now);
    bool hasEnded(const Piece &piece, double now);
    void end(const Piece &piece, double now);
    void owe(quint16 number);
    void drop(Place place);
    void makeRoom(int limit);

    std::list<Message> messages_; // touched last stands last
    std::deque<Ended> ended_;
    std::deque<quint16> due_; // reports
    qint64 bytes_ = 0;
    quint64 forgotten_ = 0;
};

} // namespace hermes
