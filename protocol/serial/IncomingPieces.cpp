#include "protocol/serial/IncomingPieces.h"

#include <algorithm>
#include <cstring>

namespace hermes {
namespace {

constexpr std::size_t maxEnded = 64, maxDue = 32;
constexpr double rememberEnded_s = 120; // longer than anybody repeats pieces
constexpr int limits = 3; // of one message: an urgent one, a usual one, and one of a topic at a time

} // namespace

IncomingPieces::Outcome IncomingPieces::take(const Piece &piece, int limit, double now, QByteArray &content) {
    forgetOld(now);
    if (piece.toReport)
        owe(piece.number);
    const Place place = find(piece);
    const bool isNew = place == messages_.end();
    if (isNew && hasEnded(piece, now))
        return Outcome::Duplicate;
    if (piece.index >= (isNew ? 0 : place->base) + windowPieces) {
        owe(piece.number);
        if (!isNew)
            drop(place);
        return Outcome::Stray;
    }
    if (isNew && qint64(piece.total) > limit) {
        end(piece, now);
        return Outcome::TooLarge;
    }
    const Outcome outcome = keep(isNew ? begin(piece) : place, piece, now);
    if (outcome == Outcome::Complete) {
        content = std::move(messages_.back().bytes);
        bytes_ -= content.size();
        messages_.pop_back();
        end(piece, now);
    }
    makeRoom(limit);
    return outcome;
}

IncomingPieces::Place IncomingPieces::begin(const Piece &piece) {
    return messages_.insert(messages_.end(), Message(piece.number, piece.total));
}

IncomingPieces::Outcome IncomingPieces::keep(Place place, const Piece &piece, double now) {
    messages_.splice(messages_.end(), messages_, place);
    place->touched = now;
    const int bit = piece.index - place->base;
    if (bit < 0 || place->later >> bit & 1)
        return Outcome::Duplicate;
    const int at = piece.index * pieceBytes, size = std::max(place->bytes.size(), at + piece.bytes.size());
    bytes_ += size - place->bytes.size();
    place->bytes.resize(size);
    std::memcpy(place->bytes.data() + at, piece.bytes.constData(), std::size_t(piece.bytes.size()));
    for (place->later |= quint64(1) << bit; place->later & 1; place->later >>= 1)
        ++place->base;
    return place->base == piece.count() ? Outcome::Complete : Outcome::Kept;
}

PieceReport IncomingPieces::takeReport() {
    const quint16 number = due_.front();
    due_.pop_front();
    const auto place = std::find_if(messages_.begin(), messages_.end(),
                                    [number](const Message &one) { return one.number == number; });
    if (place == messages_.end())
        return {number, PieceReport::ended, 0};
    return {number, quint16(place->base), place->later};
}

void IncomingPieces::forgetOld(double now) {
    while (!messages_.empty() && now - messages_.front().touched > longestPause_s)
        drop(messages_.begin());
    while (!ended_.empty() && now - ended_.front().at > rememberEnded_s)
        ended_.pop_front();
}

void IncomingPieces::clear() {
    messages_.clear();
    ended_.clear();
    due_.clear();
    bytes_ = 0;
}

IncomingPieces::Place IncomingPieces::find(const Piece &piece) {
    const auto place = std::find_if(messages_.begin(), messages_.end(),
                                    [&piece](const Message &one) { return one.number == piece.number; });
    if (place == messages_.end() || place->total == piece.total)
        return place;
    drop(place); // of a sender that has begun anew
    return messages_.end();
}

bool IncomingPieces::hasEnded(const Piece &piece, double now) {
    const auto found = std::find_if(ended_.begin(), ended_.end(), [&piece](const Ended &one) {
        return one.number == piece.number && one.total == piece.total;
    });
    if (found == ended_.end())
        return false;
    ended_.erase(found); // its sender does not know as yet
    ended_.push_back({piece.number, piece.total, now});
    return true;
}

void IncomingPieces::end(const Piece &piece, double now) {
    owe(piece.number);
    ended_.push_back({piece.number, piece.total, now});
    if (ended_.size() > maxEnded)
        ended_.pop_front();
}

void IncomingPieces::owe(quint16 number) {
    if (due_.size() < maxDue && std::find(due_.begin(), due_.end(), number) == due_.end())
        due_.push_back(number);
}

void IncomingPieces::drop(Place place) {
    bytes_ -= place->bytes.size();
    messages_.erase(place);
    ++forgotten_;
}

void IncomingPieces::makeRoom(int limit) {
    while (messages_.size() > maxMessages || (messages_.size() > 1 && bytes_ > qint64(limit) * limits))
        drop(messages_.begin());
}

} // namespace hermes
