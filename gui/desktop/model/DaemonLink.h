#pragma once

#include "gui/desktop/model/NewestOnly.h"
#include "protocol/messages/Daemons.h"

#include <QElapsedTimer>
#include <QHash>
#include <QJsonObject>
#include <QObject>
#include <QSet>
#include <QTimer>
#include <memory>

namespace hermes::desktop {

/// How a daemon is, at one glance. Each has one colour, one icon and one word (Theme.h).
enum class Condition { Ready, Busy, Warning, Fault, Unreachable };

/// A topic is subscribed to for as long as somebody has this.
using Subscription = std::shared_ptr<void>;

/// One daemon as the operator's program knows it: the connection, and what the daemon says of itself. It
/// keeps connecting, reads the description again when its hash changes, and asks for the status again and
/// again, which also measures the link. Nothing here blocks, nothing is known beforehand of any daemon, and
/// nothing that it says is trusted to make sense.
class DaemonLink : public QObject {
    Q_OBJECT
public:
    /// Between two questions; of more than a hundred daemons so long for each of them.
    static constexpr std::chrono::milliseconds pollPeriod{300}, pollShare{3};
    /// Of messages that come by themselves: what takes longer to read than the event loop may be busy is
    /// refused.
    static constexpr int usualFrame = 320 << 10;

    /// address: "HOST:PORT".
    explicit DaemonLink(const QString &address, QObject *parent = nullptr);
    ~DaemonLink() override { --links_; }

    const QString &address() const { return address_; }
    QString host() const { return address_.section(':', 0, -2); }
    quint16 port() const { return address_.section(':', -1).toUShort(); }
    /// Id and name of the robot that it says it is of; empty: it knows none.
    QString robotId() const { return info_.robot ? info_.robot->id : QString(); }
    QString robotName() const { return info_.robot ? info_.robot->name : QString(); }
    /// The same for two links that lead to one process; empty: not known.
    QString identity() const;
    /// Its own name ("motorcontrol"); before it has answered, what its supervisor calls it, the usual one of
    /// its port, or the address.
    QString name() const;
    void setSupervisedName(const QString &name) { supervisedName_ = name; }
    QString title() const;
    bool isConnected() const { return client_.isConnected(); }
    /// It has answered once; what it said then is still here when the connection is gone.
    bool isKnown() const { return !info_.name.isEmpty(); }

    Condition condition() const;
    /// What stands behind the condition in one word: the daemon's own state, "warning" or "unreachable".
    QString conditionWord() const;
    /// The worst health item as a sentence, or why there is no connection; empty when all is well.
    QString reason() const;
    /// The time of a request and its reply in milliseconds, or since a request that has no reply yet, when
    /// that is longer; negative: not measured.
    double latency_ms() const;
    /// A request has waited for its reply for longer than half a second, and than three replies took.
    bool isSilent() const;

    const DaemonStatus &status() const { return status_; }
    /// OpenRPC, with "x-topics".
    const QJsonObject &description() const { return description_; }
    /// The description of a method; empty when the daemon does not have it.
    QJsonObject method(const QString &name) const { return methods_.value(name); }
    bool hasMethod(const QString &name) const { return methods_.contains(name); }
    /// The method has a parameter of that name.
    bool takes(const QString &method, const QString &param) const;
    bool hasTopic(const QString &name) const { return topics_.contains(name); }
    /// The names of the topics, in the order of the description.
    const QStringList &topics() const { return topicNames_; }

    Client &client() { return client_; }
    /// Why this program may not call a method that the daemon has; empty: it may.
    QString refusal(const QString &method) const;
    bool may(const QString &name) const { return hasMethod(name) && refusal(name).isEmpty(); }
    /// Calls a method; the callback is dropped with the context.
    void call(const QString &method, const QJsonObject &params, QObject *context,
              const Client::Callback &done, Client::Repeats repeats = Client::Repeats::Usual);
    /// The same for an answer of up to Client::largeFrame.
    void callForMuch(const QString &method, const QJsonObject &params, QObject *context,
                     const Client::Callback &done);
    /// As Client::subscribe. Without "queue" in the options only the newest message counts, and no more of
    /// them come than "max_rate_hz" allows, or 100 a second, whatever the daemon sends.
    [[nodiscard]] Subscription subscribe(const QString &topic, const QJsonObject &options,
                                         const Client::TopicCallback &callback);

Q_SIGNALS:
    /// Connection, state, health or latency.
    void changed();
    /// A description that was not known before: methods and topics can be looked up.
    void described();
    /// Connected, described, and its description may have been the same as before.
    void ready();

private:
    int begin(const QString &topic, const QJsonObject &options, const Client::TopicCallback &callback);
    void unsubscribe(int handle);
    void onConnected();
    void introduce();
    void onDescription(const QJsonValue &description);
    void onStatus(WireView status);
    bool isUnderstood() const;
    void poll();
    void ask();

    const QString address_;
    QString supervisedName_;
    Client client_;
    static inline int links_ = 0; // of the program
    bool isLate_ = false;         // with who it is, and what it can do
    QTimer timer_;
    DaemonInfo info_;
    DaemonStatus status_;
    HealthItem worst_; // without a name: all is well
    QJsonObject description_;
    QHash<QString, QJsonObject> methods_;
    QSet<QString> topics_;
    QStringList topicNames_;
    QHash<int, NewestOnly *> gates_; // by the handle of their subscription
    QString nonsense_;               // what it said of itself that cannot be used
    quint64 shownUnreadable_ = 0;
    double latency_ms_ = -1;
    bool isPolling_ = false;
    QElapsedTimer asked_; // while it polls
    QTimer silence_;      // shows a silence as it grows
};

} // namespace hermes::desktop
