#pragma once

#include "common/Result.h"
#include "common/interface/Interface.h"
#include "protocol/jsonrpc/Codec.h"

#include <QObject>
#include <deque>
#include <memory>

namespace hermes {

/// An interface and a codec joined: messages in and out.
class Channel : public QObject {
    Q_OBJECT
public:
    /// Takes over both.
    Channel(Interface *interface, std::unique_ptr<Codec> codec, QObject *parent);

    /// The channel for a URL such as `tcp://127.0.0.1:7410?protocol=json`, not yet open.
    static Result<Channel *> make(const QString &url, QObject *parent);

    void open() { carrier->open(); }
    void close(const QString &reason);
    bool isOpen() const { return carrier->isOpen(); }

    /// Encodes and writes. Error when the message cannot be encoded, the channel is not open, or too much
    /// waits to be sent.
    Result<void> send(const QJsonValue &message);

    /// Lets messages wait, and their sender, where the interface can; others come at once all the same.
    void setReceiving(bool on);

    Interface &interface() { return *carrier; }
    Codec &codec() { return *framing; }

Q_SIGNALS:
    void opened();
    void closed(const QString &reason);
    void message(const QJsonValue &message);
    /// A frame that could not be read; the peer of a server is owed an answer.
    void malformed(const hermes::RpcError &error);

private:
    void receive(const QByteArray &bytes);
    void deliver();
    void deliverAll();
    void deliverNext();

    Interface *carrier;
    std::unique_ptr<Codec> framing;
    std::deque<CodecItem> waiting;
    const bool canWait;
    bool receiving = true;
    bool willDeliver = false; // a call is in the event queue
};

} // namespace hermes
