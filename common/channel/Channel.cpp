#include "common/channel/Channel.h"

#include "common/Time.h"
#include "common/interface/InterfaceRegistry.h"

#include <QPointer>

namespace hermes {
namespace {

constexpr double longestTurn_s = 0.001; // then other channels get theirs

} // namespace

Channel::Channel(Interface *interface, std::unique_ptr<Codec> codec, QObject *parent)
    : QObject(parent)
    , carrier(interface)
    , framing(std::move(codec))
    , canWait(interface->setReceiving(true)) {
    carrier->setParent(this);
    connect(carrier, &Interface::opened, this, [this] {
        framing->reset();
        waiting.clear();
        Q_EMIT opened();
    });
    connect(carrier, &Interface::closed, this, [this](const QString &reason) {
        const QPointer<Channel> alive(this);
        deliverAll();
        if (alive)
            Q_EMIT closed(reason);
    });
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

Result<void> Channel::send(const QJsonValue &message) {
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
    carrier->close(reason);
}

void Channel::setReceiving(bool on) {
    if (on == receiving)
        return;
    receiving = on;
    if (on && !willDeliver) {
        willDeliver = true;
        QMetaObject::invokeMethod(this, &Channel::deliver, Qt::QueuedConnection);
    }
}

void Channel::receive(const QByteArray &bytes) {
    for (CodecItem &item : framing->feed(bytes))
        waiting.push_back(std::move(item));
    if (!canWait)
        deliverAll();
    else if (!willDeliver)
        deliver();
}

void Channel::deliver() {
    willDeliver = false;
    const QPointer<Channel> alive(this);
    const double end = monotonicNow() + longestTurn_s;
    while (receiving && !waiting.empty() && monotonicNow() < end) {
        deliverNext();
        if (!alive)
            return;
    }
    carrier->setReceiving(receiving && waiting.empty());
    if (receiving && !waiting.empty()) {
        willDeliver = true;
        QMetaObject::invokeMethod(this, &Channel::deliver, Qt::QueuedConnection);
    }
}

void Channel::deliverAll() {
    const QPointer<Channel> alive(this);
    while (alive && !waiting.empty())
        deliverNext();
}

void Channel::deliverNext() {
    const CodecItem item = std::move(waiting.front());
    waiting.pop_front();
    if (item.error)
        Q_EMIT malformed(*item.error);
    else
        Q_EMIT message(item.message);
}

} // namespace hermes
