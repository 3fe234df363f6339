#pragma once

#include "protocol/jsonrpc/Greeting.h"
#include "protocol/jsonrpc/RpcError.h"
#include "protocol/wire/Outgoing.h"
#include "protocol/wire/WireValue.h"

#include <QByteArray>
#include <QJsonValue>
#include <QStringList>
#include <memory>
#include <optional>
#include <vector>

namespace hermes {

class SerialLink;

/// What a codec found in the bytes: a message, or the error that stands in place of a damaged one.
struct CodecItem {
    QJsonValue message{QJsonValue::Undefined};
    std::optional<RpcError> error;
    /// Of a topic's notification params.data, which is left out of message: it may be large, and its reader
    /// knows what to make of it.
    WireValue data;
    QByteArray digest = {}; ///< of the frame, where its reader wants one
};

/// One frame as it came, not yet read; or the error that stands in place of one that was not kept.
struct CodecFrame {
    QByteArray bytes;
    std::optional<RpcError> error;
    double arrived = 0;    ///< for who reads it later; of a clock of the reader's
    bool inPieces = false; ///< its sender knows that it has arrived
    double earliest = 0;   ///< as arrived: before that it had not come
};

/// What encode() gave: the frame, or why the message cannot be sent (then bytes is empty).
struct EncodedFrame {
    QByteArray bytes;
    std::optional<RpcError> error;
};

/// What has passed through a codec since it was made.
struct CodecCounters {
    quint64 messagesIn = 0;
    quint64 messagesOut = 0;
    quint64 malformed = 0; ///< frames whose content could not be read
    quint64 oversized = 0; ///< frames larger than the limit, skipped
    quint64 refused = 0;   ///< messages that could not be encoded
};

/// Turns bytes into messages and messages into bytes. A message is any JSON value (an object, or an array for
/// a batch), whatever the framing on the wire. Pure: the carrier feeds it and sends what it gives.
class Codec {
public:
    virtual ~Codec() = default;

    /// Looks who speaks, in the first bytes: for connections that anybody may make.
    void watchForStrangers() { watches_ = true; }
    /// Takes bytes as they arrive, split anywhere, and gives the frames completed by them in order: none when
    /// the peer turned out to speak another protocol. Costs little, whatever is in them.
    std::vector<CodecFrame> split(const QByteArray &bytes);
    /// Of the connection.
    const Greeting &greeting() const { return greeting_; }
    /// Reads a frame. Costs as much as it is long; may be called in any thread.
    CodecItem read(const CodecFrame &frame) const;
    /// Both at once.
    std::vector<CodecItem> feed(const QByteArray &bytes);
    /// Counts an item that read() gave.
    void count(const CodecItem &item);
    /// Where frames are repeated and take turns: encode() gives messages for it, and only what it gives is
    /// written. Else null.
    virtual SerialLink *link() { return nullptr; }
    /// Whether a frame has begun and not ended.
    virtual bool isMidFrame() const = 0;

    /// The message as one frame. A number that is NaN or infinite is an error that names its path.
    EncodedFrame encode(const Outgoing &message);
    /// The notification of a topic; its params come last, so that forSubscription() can add to them.
    EncodedFrame encodeTopic(const QString &topic, quint64 seq, double stamp, const Outgoing &data,
                             bool replayed = false);
    /// Frames of single replies become the pieces of one frame, that of a batch.
    virtual void joinBatch(std::vector<QByteArray> &frames) const = 0;
    /// The frame of a notification with two more members of its params, whose content one frame has for all
    /// who get it.
    virtual QByteArray forSubscription(const QByteArray &notification, quint64 subscription,
                                       quint64 dropped) const = 0;

    /// Begins anew, as the carrier was opened anew. Counters stay.
    void reset();
    /// Takes the place of another one on an open connection: limit, counters, and who speaks.
    void succeed(const Codec &other);

    /// Largest frame accepted by feed(), in bytes without its delimiter.
    void setFrameLimit(int bytes) { limit_ = bytes; }
    int frameLimit() const { return limit_; }
    /// The most values in one frame; one with more is malformed.
    void setValueLimit(int values) { inFrame_.values = values; }
    const CodecCounters &counters() const { return counts_; }

protected:
    explicit Codec(int frameLimitBytes)
        : limit_(frameLimitBytes) {}

    const WireLimits &limits() const { return inFrame_; }
    static CodecItem itemOf(const WireValue &value);
    virtual std::vector<CodecFrame> splitFrames(const QByteArray &bytes) = 0;
    /// Nothing: error says why.
    virtual std::optional<WireValue> parse(const QByteArray &frame, WireError *error) const = 0;
    /// Forgets a frame begun.
    virtual void forgetFrame() = 0;
    /// Writes a frame; path: of the number that cannot be written.
    virtual QByteArray frame(const Outgoing &message, std::optional<QString> &path) = 0;

    CodecCounters counts_;

private:
    int limit_;
    WireLimits inFrame_;
    Greeting greeting_;
    bool watches_ = false;
};

using CodecMaker = std::unique_ptr<Codec> (*)();

template <typename Kind>
std::unique_ptr<Codec> makeCodecOf() {
    return std::make_unique<Kind>();
}

/// Makes a framing known by this name before main() begins, as the initializer of a global constant. Throws
/// std::invalid_argument when there is one of that name. Gives true.
bool addCodec(const QString &name, CodecMaker make);

/// A new codec by its name in a URL (`?protocol=json`); null when there is none of that name.
std::unique_ptr<Codec> makeCodec(const QString &name);

/// The names that makeCodec knows.
QStringList codecNames();

} // namespace hermes
