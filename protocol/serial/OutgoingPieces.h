#pragma once

#include "protocol/serial/Piece.h"

#include <array>

namespace hermes {

/// How long a frame of pieces and the report on it take.
struct LinkPace {
    double bytesPerSecond = 0; ///< 0: not known
    double roundTrip_s = 0;    ///< measured; 0: not yet

    void measured(double seconds);
    /// After so long without a report something was lost.
    double timeout() const;
};

/// A large message on its way out: which of its pieces go next, by what the receiver reports. At most
/// maxInFlight are sent and not reported. What was sent before something that has arrived, and has not, is
/// lost and sent again; when no report comes, the first that are missing are.
class OutgoingPieces {
public:
    static constexpr int maxInFlight = 24; // so that a pseudo-terminal holds them

    OutgoingPieces(const QByteArray &content, quint16 messageNumber, quint64 ticketOf)
        : ticket(ticketOf)
        , content_(content)
        , number_(messageNumber)
        , count_((content.size() + pieceBytes - 1) / pieceBytes) {}

    const quint64 ticket;

    quint16 number() const { return number_; }
    int size() const { return content_.size(); }
    bool isBegun() const { return sent_ > 0; }
    bool isDone() const { return base_ == count_; }
    /// The receiver wanted no more of it before it had all.
    bool isRefused() const { return isDone() && next_ < count_; }
    /// Whether a piece may go now.
    bool hasNext() const { return nextIndex() >= 0; }
    Piece next(double now);
    /// Gives whether it is of this message.
    bool take(const PieceReport &report, LinkPace &pace, double now);
    /// When it is to ask again, if no report comes; infinite when none is owed.
    double dueAt(const LinkPace &pace) const;
    void ask();
    /// When it was begun, or a report told of a piece that has arrived.
    double lastProgress() const { return progressAt_; }
    quint64 repeated() const { return repeated_; }

private:
    struct Slot {
        quint64 sentAs = 0; // counts what was sent; 0: was not
        double sentAt = 0;
        bool toReport = false, has = false, lost = false;
    };
    Slot &slot(int index) { return slots_[std::size_t(index % windowPieces)]; }
    const Slot &slot(int index) const { return slots_[std::size_t(index % windowPieces)]; }
    int nextIndex() const;
    void lose(Slot &which);

    const QByteArray content_;
    const quint16 number_;
    const int count_;
    std::array<Slot, windowPieces> slots_;
    int base_ = 0; // the receiver has all before
    int next_ = 0; // the first that was never sent
    int inFlight_ = 0;
    int asked_ = 0; // times in vain
    quint64 sent_ = 0;
    quint64 repeated_ = 0;
    double sentAt_ = 0, progressAt_ = 0;
};

} // namespace hermes
