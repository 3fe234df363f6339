#pragma once

#include "common/Result.h"
#include "common/channel/Channel.h"
#include "common/client/Repeater.h"
#include "protocol/jsonrpc/JsonRpc.h"

#include <QElapsedTimer>
#include <QHash>
#include <QObject>
#include <QTimer>
#include <chrono>
#include <functional>
#include <map>

namespace hermes {

/// A message of a topic as a client receives it.
struct TopicUpdate {
    int handle = 0; ///< what Client::subscribe gave
    QString topic;
    quint64 seq = 0;       ///< counts the publications; a gap was thinned out or dropped
    quint64 dropped = 0;   ///< lost so far because this client read too slowly
    double stamp = 0;      ///< seconds since the epoch when the data were true
    bool replayed = false; ///< it was recorded, and says nothing of now
    WireValue data;

    QJsonValue json() const { return data.toJson(); }
};

/// A connection to a daemon: calls, subscriptions, and a new connection when the old one ends. Subscriptions
/// are made again after each reconnect; calls that wait when the connection ends fail with Disconnected. Over
/// a channel that loses messages a call is repeated while it waits; the daemon carries it out once. A line
/// has no end that would tell of a daemon's restart: who subscribes over one asks now and then who is there.
class Client : public QObject {
    Q_OBJECT
public:
    using Callback = std::function<void(const Result<QJsonValue> &)>;
    using TopicCallback = std::function<void(const TopicUpdate &)>;
    static constexpr std::chrono::milliseconds defaultTimeout{5000};
    /// Of a call, over a channel that loses messages.
    enum class Repeats {
        Usual,
        None,  ///< for what is void when it comes late: fails at once where others wait for the line
        AtOnce ///< for stops: at first without waiting for a reply; short calls that wait here are dropped,
               ///< and repeated after it
    };
    /// Of a message from the daemon, e.g. the reply that holds a map of 100,000 edges.
    static constexpr int frameLimit = 16 << 20;
    /// Of an answer that is asked for as a large one, whatever limit others have.
    static constexpr int largeFrame = 4 << 20;

    explicit Client(QObject *parent = nullptr);
    ~Client() override;

    /// Begins to connect, to "HOST:PORT" or a URL, and keeps trying until close(). Error: a bad address only.
    Result<void> connectTo(const QString &address);
    /// Over a channel of one's own, closed as yet; takes it over.
    void connectTo(Channel *newChannel);
    void close();
    /// Asks for this framing at each connection from now on, before it is told as connected; a daemon that
    /// does not know it goes on in that of the address.
    void prefer(const QString &protocol) { preferred_ = protocol; }
    bool isConnected() const { return channel_ && channel_->isOpen() && !agreeing_; }
    QString address() const;
    /// Whether what it sends may be damaged on the way, as on a serial line, and is repeated then.
    bool isLossy() const { return channel_ && channel_->isLossy(); }
    /// What came over this connection and could not be used.
    struct Rejected {
        quint64 unreadable = 0; ///< no JSON, no JSON-RPC, or larger than the limit
        quint64 unasked = 0; ///< replies that nobody waits for (any more), topics that nobody subscribed to
        QString last;        ///< what was wrong with the last unreadable one
    };
    const Rejected &rejected() const { return refused_; }
    /// Calls that were sent again.
    quint64 repeats() const { return repeater_.repeats(); }
    /// Of messages from now on, in bytes.
    void setFrameLimit(int bytes);
    /// Why the last attempt or connection ended.
    const QString &lastError() const { return failure_; }
    /// Why there is no connection, also before the first attempt has ended.
    QString problem() const;
    /// Whether that first attempt is under way, and for a few seconds at most: nothing is wrong yet.
    bool isBeginning() const;

    /// Calls a method; the callback gets the result or an error, once, and at the latest after the timeout.
    /// Not connected: fails at once (from the event loop).
    void call(const QString &method, const QJsonValue &params, const Callback &callback,
              std::chrono::milliseconds timeout = defaultTimeout, Repeats repeats = Repeats::Usual);
    /// The same for an answer of up to largeFrame.
    void callForMuch(const QString &method, const QJsonValue &params, const Callback &callback,
                     std::chrono::milliseconds timeout = defaultTimeout);
    /// Sends without expecting an answer; false when it could not be sent.
    bool notify(const QString &method, const QJsonValue &params);

    /// Waits in a nested event loop: for command line programs and tests, not for daemons.
    Result<QJsonValue> callAndWait(const QString &method, const QJsonValue &params = QJsonObject(),
                                   std::chrono::milliseconds timeout = defaultTimeout,
                                   Repeats repeats = Repeats::Usual);
    Result<void> waitConnected(std::chrono::milliseconds timeout = defaultTimeout);

    /// Subscribes now, or as soon as connected, and again after each reconnect. Options are those of
    /// topics.subscribe: {"max_rate_hz": 10, "queue": 1}. Gives a handle for unsubscribe().
    int subscribe(const QString &topic, const QJsonObject &options, const TopicCallback &callback);
    void unsubscribe(int handle);

Q_SIGNALS:
    void connected();
    /// Also after each attempt that failed.
    void disconnected(const QString &reason);
    void topic(const hermes::TopicUpdate &update);
    /// The daemon refused a subscription.
    void subscriptionFailed(int handle, const hermes::RpcError &error);

private:
    struct Subscription {
        QString topic;
        QJsonObject options;
        TopicCallback callback;
        qint64 id = 0; // the daemon's, 0 while not subscribed
    };

    void onOpened();
    void agree();
    void begin();
    void send(const QString &method, const QJsonValue &params, const Callback &callback,
              std::chrono::milliseconds timeout, bool mayBeSent, Repeats repeats = Repeats::Usual);
    void onClosed(const QString &reason);
    void onMessage(const QJsonValue &message, const WireValue &topicData);
    void refuse(const RpcError &error);
    void onResponse(const RpcResponse &response);
    void onNotification(const RpcRequest &notification, const WireValue &data);
    std::optional<int> handleOf(qint64 id, const QString &topicName) const;
    bool subscribes() const;
    void deliverEarly(qint64 id);
    void deliver(int handle, const QJsonObject &params, const WireValue &data);
    void sendSubscription(int handle);
    void lookWhoIsThere();
    void failFirst(const Error &error);
    void finish(qint64 id, const Result<QJsonValue> &result);
    /// A whole number from 0 to 2^53; negative: it is none.
    static qint64 toCount(const QJsonValue &value);

    Channel *channel_ = nullptr;
    QString failure_;
    QString preferred_;
    bool agreeing_ = false;      ///< on a framing
    bool flushing_ = false;      ///< an urgent request
    QElapsedTimer firstAttempt_; ///< invalid: it has ended
    Rejected refused_;
    int frameBytes_ = frameLimit;
    int largeCalls_ = 0; ///< that wait
    qint64 lastId_ = 0;
    QHash<qint64, Callback> waiting_;
    Repeater repeater_{nullptr};
    /// Of a topic, that came before the reply to its subscription, which was lost.
    struct Early {
        qint64 id;
        QJsonObject params;
        WireValue data;
    };
    std::vector<Early> early_;
    QTimer lookTimer_;         // over a line
    double daemonStarted_ = 0; // as it said; 0: not yet
    int lastHandle_ = 0;
    std::map<int, Subscription> subscriptions_;
};

} // namespace hermes
