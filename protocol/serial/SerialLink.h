#pragma once

#include "protocol/serial/IncomingPieces.h"
#include "protocol/serial/OutgoingPieces.h"

#include <array>
#include <deque>
#include <list>
#include <vector>

namespace hermes {

/// What has passed through a link since it was made.
struct LinkCounters {
    quint64 framesIn = 0; ///< undamaged
    quint64 framesOut = 0;
    quint64 damaged = 0;   ///< frames dropped: not COBS, wrong CRC, of no known kind, or too many
    quint64 oversized = 0; ///< messages over the limit
    quint64 repeatedPieces = 0;
    quint64 abandoned = 0; ///< messages in pieces given up, on the way in or out
};

/// One end of a line that loses and damages bytes, docs/protocol.md, framing `serial`: messages in, frames
/// out, the most urgent first; bytes in, messages out. A message that fits a frame may be lost; a larger one
/// goes in pieces, which are repeated until they have arrived. Pure: whoever drives it tells the time and
/// writes the frames, few at a time, so that none waits long behind others.
class SerialLink {
public:
    enum class Rank {
        Urgent, ///< before all others
        Usual,  ///< before pieces of others, where it is small
        Topic,  ///< in turns with large ones; always in pieces
        Assured ///< as usual, but always in pieces: it arrives, or the line is dead
    };
    struct Arrival {
        QByteArray message;
        bool inPieces = false;
        bool tooLarge = false; ///< then message is empty
    };
    /// Of the content of a frame without its CRC: what is larger goes in pieces.
    static constexpr int largestFrame = 160;
    static constexpr int maxWaiting = 16 << 20;
    /// Without a report a message in pieces is abandoned after these, the later one where a report takes
    /// long.
    static constexpr double shortestStandstill_s = 20, longestStandstill_s = 60;

    /// firstNumber: of messages in pieces; any, but another one after each start.
    explicit SerialLink(quint16 firstNumber)
        : nextNumber_(firstNumber) {}

    void setLimit(int bytes) { limit_ = bytes; }
    /// 0: not known.
    void setBytesPerSecond(double rate) { pace_.bytesPerSecond = rate; }
    double bytesPerSecond() const { return pace_.bytesPerSecond; }
    /// Of any clock that only goes forward, in seconds; before receive() and next().
    void setTime(double now);

    /// Gives a ticket for isUnderWay(), or 0: too large, or too much waits.
    quint64 send(const QByteArray &message, Rank rank);
    /// Whether it waits, or some of it has not been reported to have arrived.
    bool isUnderWay(quint64 ticket) const;
    bool hasTopicUnderWay() const { return !lane(Rank::Topic).isEmpty(); }
    qint64 bytesWaiting() const { return waiting_; }
    /// Of the usual rank, in frames of their own.
    bool hasSmallWaiting() const { return !lane(Rank::Usual).small.empty(); }
    /// Forgets those, as if the line had lost them.
    void dropSmall();

    /// The frame to be written now, with its end; empty: none.
    QByteArray next();
    bool hasNext();
    /// When next() may have one although nothing came; infinite: never.
    double wakeAt() const;

    std::vector<Arrival> receive(const QByteArray &bytes);
    bool isMidFrame() const { return !begun_.isEmpty() || !incoming_.isEmpty(); }
    /// Forgets all that is under way. Counters stay.
    void reset();
    LinkCounters counters() const;
    qint64 bytesHeld() const { return begun_.size() + incoming_.bytes(); } ///< of what is on its way in

private:
    struct Waiting {
        quint64 ticket;
        QByteArray content;
    };
    struct Lane {
        std::deque<Waiting> small, large;
        std::list<OutgoingPieces> begun;
        bool isEmpty() const { return small.empty() && large.empty() && begun.empty(); }
    };
    Lane &lane(Rank rank) { return lanes_[std::size_t(rank)]; }
    const Lane &lane(Rank rank) const { return lanes_[std::size_t(rank)]; }

    QByteArray framed(QByteArray content, bool startsAnew);
    QByteArray takeSmall(Lane &from);
    QByteArray takePiece(Lane &from);
    OutgoingPieces *nextOf(Lane &lane);
    bool mayBegin() const;
    void finishFrame(std::vector<Arrival> &arrivals);
    void takePiece(const QByteArray &frame, std::vector<Arrival> &arrivals);
    void takeReport(const QByteArray &frame);
    void retire(Lane &lane);

    std::array<Lane, 3> lanes_;
    IncomingPieces incoming_;
    LinkPace pace_;
    LinkCounters counts_;
    QByteArray begun_; // the frame
    bool skipping_ = false;
    int limit_ = 1 << 20;
    double now_ = 0;
    quint16 nextNumber_;
    quint64 lastTicket_ = 0;
    qint64 waiting_ = 0;
    bool topicsTurn_ = false;
};

} // namespace hermes
