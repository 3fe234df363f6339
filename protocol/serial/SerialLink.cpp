#include "protocol/serial/SerialLink.h"

#include "protocol/serial/Cobs.h"
#include "protocol/serial/Crc32c.h"

#include <QtEndian>
#include <algorithm>
#include <cstring>
#include <limits>

namespace hermes {
namespace {

constexpr int crcBytes = 4;
constexpr char endOfFrame = '\0';
constexpr int maxAhead = 32; // of the number of a message, while one waits for its last report
constexpr int maxQuestions = 50;
constexpr std::size_t maxAtOnce = 2; // large ones of a rank: one waits for its last report

QByteArray sealed(QByteArray content) {
    char crc[crcBytes];
    qToLittleEndian(crc32c(content.constData(), std::size_t(content.size())), crc);
    return content.append(crc, crcBytes);
}

// The content, or nothing when it is damaged.
std::optional<QByteArray> unsealed(QByteArray content) {
    const int size = content.size() - crcBytes;
    if (size <= 0 || qFromLittleEndian<quint32>(content.constData() + size) !=
                         crc32c(content.constData(), std::size_t(size)))
        return std::nullopt;
    content.chop(crcBytes);
    return content;
}

bool isMessage(const QByteArray &content) {
    return quint8(content[0]) >= quint8(FrameKind::FirstOfMessages) &&
           quint8(content[0]) <= quint8(FrameKind::LastOfMessages);
}

} // namespace

void SerialLink::setTime(double now) {
    now_ = now;
    incoming_.forgetOld(now);
    for (Lane &lane : lanes_) {
        for (OutgoingPieces &message : lane.begun)
            if (now >= message.dueAt(pace_))
                message.ask();
        retire(lane);
    }
}

quint64 SerialLink::send(const QByteArray &message, Rank rank) {
    const qint64 size = message.size();
    if (size + crcBytes > qint64(maxPieces) * pieceBytes || waiting_ + size > maxWaiting)
        return 0;
    const quint64 ticket = ++lastTicket_;
    const bool isWhole = size <= largestFrame && rank <= Rank::Usual;
    Lane &way = lane(rank == Rank::Assured ? Rank::Usual : rank);
    if (isWhole)
        way.small.push_back({ticket, message});
    else
        way.large.push_back({ticket, sealed(message)});
    waiting_ += isWhole ? size : size + crcBytes;
    return ticket;
}

bool SerialLink::isUnderWay(quint64 ticket) const {
    const auto isIt = [ticket](const auto &one) { return one.ticket == ticket; };
    return std::any_of(lanes_.begin(), lanes_.end(), [&isIt](const Lane &lane) {
        return std::any_of(lane.small.begin(), lane.small.end(), isIt) ||
               std::any_of(lane.large.begin(), lane.large.end(), isIt) ||
               std::any_of(lane.begun.begin(), lane.begun.end(), isIt);
    });
}

void SerialLink::dropSmall() {
    for (const Waiting &one : lane(Rank::Usual).small)
        waiting_ -= one.content.size();
    lane(Rank::Usual).small.clear();
}

OutgoingPieces *SerialLink::nextOf(Lane &lane) {
    for (OutgoingPieces &message : lane.begun)
        if (message.hasNext())
            return &message;
    if (lane.large.empty() || lane.begun.size() == maxAtOnce || !mayBegin())
        return nullptr;
    const Waiting next = std::move(lane.large.front());
    lane.large.pop_front();
    return &lane.begun.emplace_back(next.content, nextNumber_++, next.ticket);
}

// The receiver remembers so many that it has had.
bool SerialLink::mayBegin() const {
    return std::all_of(lanes_.begin(), lanes_.end(), [this](const Lane &lane) {
        return std::all_of(lane.begun.begin(), lane.begun.end(), [this](const OutgoingPieces &message) {
            return quint16(nextNumber_ - message.number()) < maxAhead;
        });
    });
}

bool SerialLink::hasNext() {
    return incoming_.isReportDue() || std::any_of(lanes_.begin(), lanes_.end(), [this](Lane &lane) {
               return !lane.small.empty() || nextOf(lane);
           });
}

QByteArray SerialLink::next() {
    Lane &urgent = lane(Rank::Urgent), &usual = lane(Rank::Usual), &topic = lane(Rank::Topic);
    if (!urgent.small.empty())
        return takeSmall(urgent);
    if (incoming_.isReportDue())
        return framed(incoming_.takeReport().toFrame(), false);
    if (nextOf(urgent))
        return takePiece(urgent);
    if (!usual.small.empty())
        return takeSmall(usual);
    topicsTurn_ = nextOf(topic) && (!topicsTurn_ || !nextOf(usual));
    if (topicsTurn_)
        return takePiece(topic);
    return nextOf(usual) ? takePiece(usual) : QByteArray();
}

QByteArray SerialLink::takeSmall(Lane &from) {
    const QByteArray content = std::move(from.small.front().content);
    from.small.pop_front();
    waiting_ -= content.size();
    return framed(content, true);
}

QByteArray SerialLink::takePiece(Lane &from) {
    OutgoingPieces &message = *nextOf(from);
    const quint64 repeated = message.repeated();
    const QByteArray frame = framed(message.next(now_).toFrame(), false);
    counts_.repeatedPieces += message.repeated() - repeated;
    return frame;
}

// A message begins with the end of what came before: damage to that, or noise, then does not take it along.
QByteArray SerialLink::framed(QByteArray content, bool startsAnew) {
    ++counts_.framesOut;
    const QByteArray frame = cobsEncoded(sealed(std::move(content))).append(endOfFrame);
    return startsAnew ? endOfFrame + frame : frame;
}

double SerialLink::wakeAt() const {
    double at = std::numeric_limits<double>::infinity();
    for (const Lane &lane : lanes_)
        for (const OutgoingPieces &message : lane.begun)
            at = std::min(at, message.dueAt(pace_));
    return at;
}

std::vector<SerialLink::Arrival> SerialLink::receive(const QByteArray &bytes) {
    std::vector<Arrival> arrivals;
    const char *at = bytes.constData();
    const char *const end = at + bytes.size();
    const qint64 longest = qint64(limit_) + crcBytes + limit_ / 254 + 2;
    while (at < end) {
        const auto *zero = static_cast<const char *>(std::memchr(at, endOfFrame, std::size_t(end - at)));
        const char *const stop = zero ? zero : end;
        if (!skipping_ && begun_.size() + (stop - at) > longest) {
            skipping_ = true;
            begun_ = QByteArray();
            ++counts_.oversized;
            arrivals.push_back({{}, false, true});
        }
        if (!skipping_)
            begun_.append(at, int(stop - at));
        if (!zero)
            break;
        if (!skipping_)
            finishFrame(arrivals);
        skipping_ = false;
        at = zero + 1;
    }
    return arrivals;
}

void SerialLink::finishFrame(std::vector<Arrival> &arrivals) {
    if (begun_.isEmpty())
        return;
    const auto bytes = cobsDecoded(begun_.constData(), begun_.size());
    begun_ = QByteArray();
    const auto content = bytes ? unsealed(*bytes) : std::nullopt;
    if (!content) {
        ++counts_.damaged;
        return;
    }
    ++counts_.framesIn;
    const auto kind = FrameKind(quint8((*content)[0]));
    if (isMessage(*content))
        arrivals.push_back({*content, false, false});
    else if (kind == FrameKind::Piece || kind == FrameKind::PieceToReport)
        takePiece(*content, arrivals);
    else if (kind == FrameKind::Report)
        takeReport(*content);
    else
        ++counts_.damaged;
}

void SerialLink::takePiece(const QByteArray &frame, std::vector<Arrival> &arrivals) {
    const auto piece = Piece::fromFrame(frame);
    if (!piece) {
        ++counts_.damaged;
        return;
    }
    QByteArray whole;
    const auto outcome = incoming_.take(*piece, limit_ + crcBytes, now_, whole);
    if (outcome == IncomingPieces::Outcome::TooLarge) {
        ++counts_.oversized;
        arrivals.push_back({{}, true, true});
    }
    if (outcome != IncomingPieces::Outcome::Complete)
        return;
    const auto content = unsealed(std::move(whole)); // pieces of two senders may have the same number
    if (content && isMessage(*content))
        arrivals.push_back({*content, true, false});
    else
        ++counts_.damaged;
}

void SerialLink::takeReport(const QByteArray &frame) {
    const auto report = PieceReport::fromFrame(frame);
    if (!report) {
        ++counts_.damaged;
        return;
    }
    for (Lane &lane : lanes_) {
        for (OutgoingPieces &message : lane.begun)
            message.take(*report, pace_, now_);
        retire(lane);
    }
}

void SerialLink::retire(Lane &lane) {
    const double most_s =
        std::clamp(maxQuestions * pace_.timeout(), shortestStandstill_s, longestStandstill_s);
    const auto isOver = [this, most_s](const OutgoingPieces &message) {
        const bool isDead = message.isBegun() && now_ - message.lastProgress() > most_s;
        if (!message.isDone() && !isDead)
            return false;
        counts_.abandoned += !message.isDone() || message.isRefused();
        waiting_ -= message.size();
        return true;
    };
    lane.begun.remove_if(isOver);
}

void SerialLink::reset() {
    for (Lane &lane : lanes_) {
        lane.small.clear();
        lane.large.clear();
        lane.begun.clear();
    }
    incoming_.clear();
    begun_ = QByteArray();
    skipping_ = false;
    waiting_ = 0;
}

LinkCounters SerialLink::counters() const {
    LinkCounters all = counts_;
    all.abandoned += incoming_.forgotten();
    return all;
}

} // namespace hermes
