#include "protocol/serial/OutgoingPieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hermes {
namespace {

constexpr int reportEvery = 4, askFor = 4;
constexpr double firstTimeout_s = 0.25, leastTimeout_s = 0.03, longestPause_s = 1;
constexpr double growth = 1.5; // of the time between two questions
constexpr int frameBytes = Piece::headerBytes + pieceBytes + 7;

} // namespace

void LinkPace::measured(double seconds) {
    const double weight = roundTrip_s == 0        ? 1
                          : seconds < roundTrip_s ? 0.5
                                                  : 0.125; // a late one was lost before
    roundTrip_s += weight * (seconds - roundTrip_s);
}

double LinkPace::timeout() const {
    const double ofFrames = bytesPerSecond > 0 ? 4 * frameBytes / bytesPerSecond : 0;
    return leastTimeout_s + ofFrames + (roundTrip_s > 0 ? 2 * roundTrip_s : firstTimeout_s);
}

int OutgoingPieces::nextIndex() const {
    for (int i = base_; i < next_; ++i)
        if (slot(i).lost)
            return i;
    const bool mayBegin = next_ < count_ && next_ < base_ + windowPieces && inFlight_ < maxInFlight;
    return mayBegin ? next_ : -1;
}

Piece OutgoingPieces::next(double now) {
    const int index = nextIndex();
    if (index == next_)
        slot(next_++) = Slot();
    else
        ++repeated_;
    Slot &which = slot(index);
    if (sent_ == 0)
        progressAt_ = now;
    which.lost = false;
    which.sentAs = ++sent_;
    which.sentAt = sentAt_ = now;
    ++inFlight_;
    which.toReport = sent_ % reportEvery == 0 || !hasNext();
    return {which.toReport, number_, quint16(index), quint32(content_.size()),
            content_.mid(index * pieceBytes, pieceBytes)};
}

void OutgoingPieces::lose(Slot &which) {
    which.lost = true;
    --inFlight_;
}

bool OutgoingPieces::take(const PieceReport &report, LinkPace &pace, double now) {
    if (report.number != number_ || !isBegun())
        return false;
    if (report.base == PieceReport::ended) {
        base_ = count_;
        return true;
    }
    if (report.base < base_ || report.base > next_)
        return true; // an old one, or nonsense
    const Slot *newest = nullptr;
    for (int i = base_; i < next_; ++i) {
        Slot &which = slot(i);
        const int bit = i - report.base;
        if (which.has || (bit >= 0 && (bit >= windowPieces || !(report.later >> bit & 1))))
            continue;
        inFlight_ -= !which.lost;
        which.lost = false;
        which.has = true;
        if (!newest || newest->sentAs < which.sentAs)
            newest = &which;
    }
    if (!newest)
        return true;
    progressAt_ = now;
    asked_ = 0;
    if (newest->toReport)
        pace.measured(now - newest->sentAt);
    for (int i = base_; i < next_; ++i)
        if (Slot &which = slot(i); !which.has && !which.lost && which.sentAs < newest->sentAs)
            lose(which);
    while (base_ < next_ && slot(base_).has)
        ++base_;
    return true;
}

double OutgoingPieces::dueAt(const LinkPace &pace) const {
    if (inFlight_ == 0)
        return std::numeric_limits<double>::infinity();
    const double timeout_s = pace.timeout();
    return sentAt_ + std::min(std::max(longestPause_s, timeout_s), timeout_s * std::pow(growth, asked_));
}

void OutgoingPieces::ask() {
    ++asked_;
    int left = askFor;
    for (int i = base_; i < next_ && left > 0; ++i)
        if (Slot &which = slot(i); !which.has && !which.lost) {
            lose(which);
            --left;
        }
}

} // namespace hermes
