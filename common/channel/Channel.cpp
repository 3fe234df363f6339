#include "common/channel/Channel.h"

#include "common/Time.h"
#include "common/Turns.h"
#include "common/interface/InterfaceRegistry.h"

#include <QCoreApplication>
#include <QPointer>

namespace hermes {
namespace {

// The time, but never twice the same.
double nextArrival() {
    static thread_local double last = 0;
    return last = std::max(bootNow(), last + 1e-9);
}

constexpr qint64 readAheadBytes = 64 << 10; // of frames that wait; then their sender does

} // namespace

Channel::Channel(Interface *interface, std::unique_ptr<Codec> codec, QObject *parent)
    : QObject(parent)
    , carrier(interface)
    , framing(std::move(codec))
    , canWait(interface->setReceiving(true)) {
    carrier->setParent(this);
    connect(carrier, &Interface::opened, this, [this] {
        if (ended)
            deliverAll();
        ++opening;
        framing->reset();
        waiting.clear();
        waitingBytes = 0;
        readFront.reset();
        reads = false;
        Q_EMIT opened();
    });
    connect(carrier, &Interface::closed, this, &Channel::end);
    connect(carrier, &Interface::received, this, &Channel::receive);
}

Result<Channel *> Channel::make(const QString &text, QObject *parent) {
    const auto url = InterfaceUrl::parse(text);
    if (!url)
        return url.error();
    auto codec = makeCodec(url->protocol());
    if (!codec) {
        return Error(ErrorCode::InvalidParams,
                     QStringLiteral("address %1: unknown protocol \"%2\", known are: %3")
                         .arg(text, url->protocol(), codecNames().join(QStringLiteral(", "))));
    }
    const auto interface = makeInterface(*url, nullptr);
    if (!interface)
        return interface.error();
    return new Channel(*interface, std::move(codec), parent);
}

Result<void> Channel::send(const Outgoing &message) {
    const EncodedFrame frame = framing->encode(message);
    if (frame.error)
        return *frame.error;
    if (!carrier->write(frame.bytes)) {
        return Error(isOpen() ? ErrorCode::OverLimit : ErrorCode::Disconnected,
                     QStringLiteral("%1: %2").arg(carrier->name(),
                                                  isOpen() ? QStringLiteral("too much waits to be sent")
                                                           : QStringLiteral("not connected")));
    }
    return {};
}

void Channel::close(const QString &reason) {
    waiting.clear(); // nobody wants them
    waitingBytes = 0;
    if (ended)
        deliverAll();
    else
        carrier->close(reason);
}

void Channel::setReceiving(bool on) {
    receiving = on;
    schedule();
}

bool Channel::isQuiet() const {
    return waiting.empty() && !framing->isMidFrame() && !carrier->hasUnread();
}

void Channel::receive(const QByteArray &bytes) {
    const QPointer<Channel> alive(this);
    bool hasJumped = false; // a flood of urgent ones is as ordinary as any
    for (CodecFrame &frame : framing->split(bytes)) {
        frame.arrived = nextArrival();
        if (urgent && !hasJumped && !frame.error && urgent(frame.bytes)) {
            hasJumped = true;
            give(framing->read(frame), frame.arrived);
            if (!alive)
                return;
            continue;
        }
        waitingBytes += frame.bytes.size();
        waiting.push_back(std::move(frame));
    }
    canWait ? schedule() : deliverAll();
}

void Channel::end(const QString &reason) {
    ended = reason;
    if (!canWait || waiting.empty())
        deliverAll();
    else
        schedule();
}

void Channel::schedule() {
    updateReceiving();
    if (scheduled || reads || !receiving || waiting.empty())
        return;
    scheduled = true;
    Turns::ofThread().add(this, [this] { return deliverNext(); });
}

void Channel::updateReceiving() {
    carrier->setReceiving(waitingBytes < readAheadBytes);
}

bool Channel::deliverNext() {
    scheduled = false;
    if (!receiving || waiting.empty())
        return false;
    if (waiting.front().bytes.size() > largeFrame && !readFront) {
        readInBackground();
        return false;
    }
    const QPointer<Channel> alive(this);
    deliverFront();
    if (!alive)
        return false;
    if (ended && waiting.empty()) {
        deliverAll();
        return false;
    }
    updateReceiving();
    if (scheduled || !receiving || waiting.empty())
        return false;
    return scheduled = true;
}

void Channel::deliverAll() {
    const QPointer<Channel> alive(this);
    while (alive && !waiting.empty())
        deliverFront();
    if (alive && ended)
        Q_EMIT closed(*std::exchange(ended, std::nullopt));
}

void Channel::deliverFront() {
    const CodecFrame frame = std::move(waiting.front());
    waiting.pop_front();
    waitingBytes -= frame.bytes.size();
    const bool isLarge = readFront.has_value();
    CodecItem item = readFront ? *std::exchange(readFront, std::nullopt) : framing->read(frame);
    reads = false;
    give(item, frame.arrived);
    if (isLarge)
        inBackground([large = std::move(item)] {}); // to free it takes long, too
}

void Channel::readInBackground() {
    reads = true;
    const auto readIt = [codec = framing, frame = waiting.front(), number = opening,
                         self = QPointer<Channel>(this)] {
        const CodecItem item = codec->read(frame);
        const auto deliver = [self, item, number] {
            if (!self || !self->reads || self->opening != number)
                return;
            self->reads = false;
            self->readFront = item;
            self->schedule();
        };
        if (QCoreApplication *application = QCoreApplication::instance())
            QMetaObject::invokeMethod(application, deliver, Qt::QueuedConnection);
    };
    inBackground(readIt);
}

void Channel::give(const CodecItem &item, double arrived) {
    arrival = arrived;
    framing->count(item);
    if (item.error)
        Q_EMIT malformed(*item.error);
    else
        Q_EMIT message(item.message, item.data);
}

} // namespace hermes
