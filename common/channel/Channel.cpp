#include "common/channel/Channel.h"

#include "common/Time.h"
#include "common/Turns.h"
#include "common/channel/PacedWriter.h"
#include "common/interface/InterfaceRegistry.h"

#include <QCoreApplication>
#include <QCryptographicHash>
#include <QPointer>
#include <QScopeGuard>

namespace hermes {
namespace {

// The time, but never twice the same.
double nextArrival() {
    static thread_local double last = 0;
    return last = std::max(bootNow(), last + 1e-9);
}

// What a frame costs that waits; one may be empty.
qint64 costOf(const CodecFrame &frame) {
    return frame.bytes.size() + qint64(sizeof(CodecFrame));
}

// So much may lie with the system before messages of topics wait where newer ones can replace them.
constexpr qint64 topicsHandOverBytes = 32 << 10;

CodecItem readAll(const Codec &codec, const CodecFrame &frame, bool withDigest) {
    CodecItem item = codec.read(frame);
    if (withDigest)
        item.digest = QCryptographicHash::hash(frame.bytes, QCryptographicHash::Sha1);
    return item;
}

constexpr qint64 readAheadBytes = 64 << 10; // of frames that wait; then their sender does
constexpr qint64 maxOfALine = 2 << 20;      // the same, and one more; then they are lost

} // namespace

Channel::Channel(Interface *interface, std::unique_ptr<Codec> codec, QObject *parent)
    : QObject(parent)
    , carrier_(interface)
    , firstFraming_(std::move(codec))
    , canWait_(interface->setReceiving(true)) {
    carrier_->setParent(this);
    setFraming(firstFraming_);
    connect(carrier_, &Interface::opened, this, [this] {
        if (ended_)
            deliverAll();
        ++opening_;
        if (framing_ != firstFraming_) {
            firstFraming_->succeed(*framing_);
            setFraming(firstFraming_);
        }
        framing_->reset();
        waiting_.clear();
        waitingBytes_ = 0;
        readFront_.reset();
        reads_ = false;
        Q_EMIT opened();
    });
    connect(carrier_, &Interface::closed, this, &Channel::end);
    connect(carrier_, &Interface::received, this, &Channel::receive);
    connect(carrier_, &Interface::drained, this, &Channel::drained);
}

Channel::~Channel() = default;

void Channel::setFraming(const std::shared_ptr<Codec> &codec) {
    writer_.reset();
    framing_ = codec;
    if (!framing_->link())
        return;
    writer_ = std::make_unique<PacedWriter>(*carrier_, framing_, nullptr);
    connect(writer_.get(), &PacedWriter::resumed, this, &Channel::drained);
}

Result<Channel *> Channel::make(const QString &text, QObject *parent) {
    const auto url = InterfaceUrl::parse(text);
    if (!url)
        return url.error();
    auto codec = makeCodec(url->protocol());
    if (!codec) {
        return Error(ErrorCode::InvalidParams,
                     QString("address %1: unknown protocol \"%2\", known are: %3")
                         .arg(text, url->protocol(), codecNames().join(QStringLiteral(", "))));
    }
    const auto interface = makeInterface(*url, nullptr);
    if (!interface)
        return interface.error();
    return new Channel(*interface, std::move(codec), parent);
}

Result<Sent> Channel::send(const Outgoing &message, Rank rank) {
    const EncodedFrame frame = framing_->encode(message);
    if (frame.error)
        return *frame.error;
    if (const auto ticket = write(frame.bytes, rank))
        return Sent{frame.bytes, *ticket};
    return Error(isOpen() ? ErrorCode::OverLimit : ErrorCode::Disconnected,
                 QString("%1: %2").arg(carrier_->name(), isOpen()
                                                             ? QStringLiteral("too much waits to be sent")
                                                             : QStringLiteral("not connected")));
}

std::optional<quint64> Channel::write(const QByteArray &frame, Rank rank) {
    if (!writer_)
        return carrier_->write(frame) ? std::make_optional<quint64>(0) : std::nullopt;
    const quint64 ticket = isOpen() ? writer_->link().send(frame, rank) : 0;
    if (ticket == 0)
        return std::nullopt;
    writer_->pump();
    return ticket;
}

bool Channel::isUnderWay(quint64 ticket) const {
    return writer_ && writer_->link().isUnderWay(ticket);
}

bool Channel::hasShortWaiting() const {
    return writer_ && writer_->link().hasSmallWaiting();
}

void Channel::dropShortWaiting() {
    if (writer_)
        writer_->link().dropSmall();
}

qint64 Channel::bytesToWrite() const {
    return carrier_->bytesToWrite() + (writer_ ? writer_->link().bytesWaiting() : 0);
}

bool Channel::hasSpaceForTopics() const {
    if (!isOpen())
        return false;
    return writer_ ? !writer_->link().hasTopicUnderWay() : carrier_->bytesToWrite() < topicsHandOverBytes;
}

LinkCounters Channel::linkCounters() const {
    LinkCounters all = writer_ ? writer_->link().counters() : LinkCounters();
    all.damaged += overruns_;
    return all;
}

void Channel::close(const QString &reason) {
    waiting_.clear(); // nobody wants them
    waitingBytes_ = 0;
    if (ended_)
        deliverAll();
    else
        carrier_->close(reason);
}

void Channel::setCodec(std::unique_ptr<Codec> codec) {
    codec->succeed(*framing_);
    setFraming(std::move(codec));
}

void Channel::setReceiving(bool on) {
    receiving_ = on;
    schedule();
}

bool Channel::isQuiet() const {
    return waiting_.empty() && !framing_->isMidFrame() && !carrier_->hasUnread();
}

void Channel::receive(const QByteArray &bytes) {
    const QPointer<Channel> alive(this);
    const bool wasForeign = framing_->greeting().isForeign();
    if (writer_)
        writer_->link().setTime(monotonicNow());
    const auto answerLink = qScopeGuard([this, alive] {
        if (alive && writer_)
            writer_->resume();
    });
    QStringList jumped; // a flood of urgent ones is as ordinary as any
    for (CodecFrame &frame : framing_->split(bytes)) {
        frame.arrived = nextArrival();
        frame.earliest = carrier_->unreadSince();
        const QString urgent = urgent_ && !frame.error ? urgent_(frame.bytes, jumped) : QString();
        if (!urgent.isEmpty()) {
            jumped.append(urgent);
            give(readAll(*framing_, frame, isLossy()), frame);
            if (!alive)
                return;
            continue;
        }
        if (isLine() &&
            waitingBytes_ > maxOfALine) { // it cannot be told to wait; who wants an answer repeats
            ++overruns_;
            continue;
        }
        waitingBytes_ += costOf(frame);
        waiting_.push_back(std::move(frame));
    }
    if (framing_->greeting().isForeign()) {
        if (!wasForeign)
            Q_EMIT foreign(RpcError(ErrorCode::InvalidRequest, framing_->greeting().reason()));
        return;
    }
    canWait_ || isLine() ? schedule() : deliverAll();
}

void Channel::end(const QString &reason) {
    ended_ = reason;
    if (!canWait_ || waiting_.empty())
        deliverAll();
    else
        schedule();
}

void Channel::schedule() {
    updateReceiving();
    if (scheduled_ || reads_ || !receiving_ || waiting_.empty())
        return;
    scheduled_ = true;
    Turns::ofThread().add(this, [this] { return deliverNext(); });
}

void Channel::updateReceiving() {
    carrier_->setReceiving(waitingBytes_ < readAheadBytes);
}

bool Channel::deliverNext() {
    scheduled_ = false;
    if (!receiving_ || waiting_.empty())
        return false;
    if (waiting_.front().bytes.size() > largeFrame_ && !readFront_) {
        readInBackground();
        return false;
    }
    const QPointer<Channel> alive(this);
    deliverFront();
    if (!alive)
        return false;
    if (ended_ && waiting_.empty()) {
        deliverAll();
        return false;
    }
    updateReceiving();
    if (scheduled_ || !receiving_ || waiting_.empty())
        return false;
    return scheduled_ = true;
}

void Channel::deliverAll() {
    const QPointer<Channel> alive(this);
    while (alive && !waiting_.empty())
        deliverFront();
    if (alive && ended_)
        Q_EMIT closed(*std::exchange(ended_, std::nullopt));
}

void Channel::deliverFront() {
    const CodecFrame frame = std::move(waiting_.front());
    waiting_.pop_front();
    waitingBytes_ -= costOf(frame);
    const bool isLarge = readFront_.has_value();
    CodecItem item =
        readFront_ ? *std::exchange(readFront_, std::nullopt) : readAll(*framing_, frame, isLossy());
    reads_ = false;
    give(item, frame);
    if (isLarge)
        inBackground([large = std::move(item)] {}); // to free it takes long, too
}

void Channel::readInBackground() {
    reads_ = true;
    const auto readIt = [codec = framing_, frame = waiting_.front(), number = opening_,
                         withDigest = isLossy(), self = QPointer<Channel>(this)] {
        const CodecItem item = readAll(*codec, frame, withDigest);
        const auto deliver = [self, item, number] {
            if (!self || !self->reads_ || self->opening_ != number)
                return;
            self->reads_ = false;
            self->readFront_ = item;
            self->schedule();
        };
        if (QCoreApplication *application = QCoreApplication::instance())
            QMetaObject::invokeMethod(application, deliver, Qt::QueuedConnection);
    };
    inBackground(readIt);
}

void Channel::give(const CodecItem &item, const CodecFrame &frame) {
    arrival_ = {frame.arrived, frame.earliest};
    inPieces_ = frame.inPieces;
    digest_ = item.digest;
    framing_->count(item);
    if (item.error)
        Q_EMIT malformed(*item.error);
    else
        Q_EMIT message(item.message, item.data);
}

} // namespace hermes
