#pragma once

#include "common/Result.h"
#include "common/interface/Interface.h"
#include "protocol/jsonrpc/Codec.h"
#include "protocol/serial/SerialLink.h"

#include <QObject>
#include <QStringList>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

namespace hermes {

class PacedWriter;

/// When a message came, of the clock of bootNow().
struct Arrival {
    double time = 0; ///< when it was read. No two in a thread are the same: what came first has the smaller
    double earliest = 0; ///< since then something of its sender has always been unread: it may be so old
};

/// What was sent, for who may have to repeat it or asks where it is.
struct Sent {
    QByteArray frame;
    quint64 ticket = 0;
};

/// An interface and a codec joined: messages in and out.
class Channel : public QObject {
    Q_OBJECT
public:
    /// Takes over both.
    Channel(Interface *interface, std::unique_ptr<Codec> codec, QObject *parent);
    ~Channel() override;

    /// The channel for a URL such as `tcp://127.0.0.1:7410?protocol=json`, not yet open.
    static Result<Channel *> make(const QString &url, QObject *parent);

    void open() { carrier_->open(); }
    void close(const QString &reason);
    bool isOpen() const { return carrier_->isOpen(); }

    using Rank = SerialLink::Rank;
    /// Encodes and writes. Error when the message cannot be encoded, the channel is not open, or too much
    /// waits to be sent. Ranks matter where frames take turns, see SerialLink.
    Result<Sent> send(const Outgoing &message, Rank rank = Rank::Usual);
    /// Writes what the codec made. Gives a ticket for isUnderWay(); nothing when it was not taken.
    std::optional<quint64> write(const QByteArray &frame, Rank rank = Rank::Usual);
    /// Whether frames may be lost, and who asks repeats it.
    bool isLossy() const { return writer_ != nullptr; }
    /// Whether it is lossy and never ends: whoever speaks next may be somebody else.
    bool isLine() const { return isLossy() && !canWait_; }
    /// Whether some of it waits here, or is repeated until it has arrived: of lossy channels.
    bool isUnderWay(quint64 ticket) const;
    /// Whether something short waits here for its turn: what is sent now comes later. Of lossy channels.
    bool hasShortWaiting() const;
    /// Drops what is short and waits here, as if the line had lost it.
    void dropShortWaiting();
    /// Come and not yet given.
    qint64 bytesToRead() const { return waitingBytes_; }
    /// Taken and not yet given to the system.
    qint64 bytesToWrite() const;
    /// Whether a message of a topic would go out soon: until then it waits where a newer one can replace it.
    bool hasSpaceForTopics() const;
    void flush() { carrier_->flush(); }

    /// Lets messages wait, and their sender, where the interface can; others come at once all the same.
    void setReceiving(bool on);
    /// Gives what is urgent about a frame, unless it is among `had`; empty: nothing.
    using UrgentName = std::function<QString(const QByteArray &frame, const QStringList &had)>;
    /// Urgent frames are delivered when they arrive, before all that wait: one of each name of those that
    /// come together.
    void setUrgent(UrgentName nameOf) { urgent_ = std::move(nameOf); }
    /// Reads frames larger than this in the background. For channels of the main thread.
    void setLargeFrame(int bytes) { largeFrame_ = bytes; }
    /// Goes on in another framing until the carrier is opened anew.
    void setCodec(std::unique_ptr<Codec> codec);
    /// When the message that is being given came.
    const Arrival &arrived() const { return arrival_; }
    /// Whether that came in pieces: then its sender knows that it has arrived.
    bool arrivedInPieces() const { return inPieces_; }
    /// Of its frame, where it may be a repeat.
    const QByteArray &digest() const { return digest_; }
    /// Whether messages wait here to be given.
    bool hasWaiting() const { return !waiting_.empty(); }
    /// Nothing of a message waits here or with the system.
    bool isQuiet() const;

    Interface &interface() { return *carrier_; }
    const Interface &interface() const { return *carrier_; }
    Codec &codec() { return *framing_; }
    LinkCounters linkCounters() const;

Q_SIGNALS:
    /// Some waiting bytes went out, or there is room again.
    void drained();
    void opened();
    void closed(const QString &reason);
    void message(const QJsonValue &message, const hermes::WireValue &topicData);
    /// A frame that could not be read; the peer of a server is owed an answer.
    void malformed(const hermes::RpcError &error);
    /// The peer speaks another protocol: nothing that it says until the next opening is read.
    void foreign(const hermes::RpcError &error);

private:
    void setFraming(const std::shared_ptr<Codec> &codec);
    void receive(const QByteArray &bytes);
    void end(const QString &reason);
    void schedule();
    bool deliverNext();
    void deliverAll();
    void deliverFront();
    void readInBackground();
    void give(const CodecItem &item, const CodecFrame &frame);
    void updateReceiving();

    Interface *carrier_;
    const std::shared_ptr<Codec> firstFraming_;
    std::shared_ptr<Codec> framing_;      // also of who reads in the background
    std::unique_ptr<PacedWriter> writer_; // where the framing has a link
    std::deque<CodecFrame> waiting_;
    qint64 waitingBytes_ = 0;
    quint64 overruns_ = 0; // frames of a line that had no place
    Arrival arrival_;
    bool inPieces_ = false;
    QByteArray digest_;
    std::optional<CodecItem> readFront_; // what is in the first of them, when it was read in the background
    std::optional<QString> ended_;       // the carrier is closed; what was said before is still delivered
    UrgentName urgent_;
    int largeFrame_ = std::numeric_limits<int>::max();
    const bool canWait_;
    bool receiving_ = true;
    bool scheduled_ = false;
    bool reads_ = false;  // in the background
    quint64 opening_ = 0; // what is read for an earlier one is not wanted
};

} // namespace hermes
