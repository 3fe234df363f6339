#include "common/channel/Channel.h"

#include "common/interface/InterfaceRegistry.h"

#include <QPointer>

namespace hermes {

Channel::Channel(Interface *interface, std::unique_ptr<Codec> codec, QObject *parent)
    : QObject(parent)
    , carrier(interface)
    , framing(std::move(codec)) {
    carrier->setParent(this);
    connect(carrier, &Interface::opened, this, [this] {
        framing->reset();
        Q_EMIT opened();
    });
    connect(carrier, &Interface::closed, this, &Channel::closed);
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

void Channel::receive(const QByteArray &bytes) {
    const QPointer<Channel> alive(this);
    for (const CodecItem &item : framing->feed(bytes)) {
        if (!alive || !isOpen())
            return; // a message before closed the channel
        if (item.error)
            Q_EMIT malformed(*item.error);
        else
            Q_EMIT message(item.message);
    }
}

} // namespace hermes
