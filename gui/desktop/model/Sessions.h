#pragma once

#include "gui/desktop/model/Freshness.h"
#include "gui/desktop/model/TopicFeed.h"
#include "protocol/messages/Sessions.h"

namespace hermes::desktop {

/// The sessions of the chosen robot, as its recorder tells them in the topic `session`, and its commands. The
/// recorder owns them: what was begun here goes on without this program.
class Sessions : public QObject {
    Q_OBJECT
public:
    explicit Sessions(Fleet &fleet, QObject *parent = nullptr);

    /// Null: the robot has none; one that is away is known.
    DaemonLink *recorder() const { return feed_.source(); }
    /// It can be asked.
    bool isThere() const { return recorder() && recorder()->isConnected(); }
    /// What it has told last.
    const SessionState &state() const { return state_; }
    const Freshness &age() const { return age_; }
    /// Why what it tells cannot be read; empty: it can.
    const QString &problem() const { return problem_; }
    bool isRecording() const { return state_.state == "recording" || state_.state == "stopping"; }
    /// The recorder replays, or a daemon says in its health that it shows a replay, whoever began it.
    bool isReplaying() const { return !replay_.isEmpty(); }
    /// What is replayed, and how far it is, for people; empty: nothing.
    const QString &replay() const { return replay_; }

    /// Asks the recorder; the callback is dropped with the context.
    void call(const QString &method, const QJsonObject &params, QObject *context,
              const Client::Callback &done);
    /// The same for what a hand changes faster than it is answered: of those that wait only the newest of
    /// each method is sent.
    void order(const QString &method, const QJsonObject &params);
    /// An order of this method waits for its answer.
    bool isOrdered(const QString &method) const { return orders_.contains(method); }

Q_SIGNALS:
    void changed();
    /// Another text of replay().
    void replayChanged();
    /// Why an order was refused.
    void refused(const QString &why);

private:
    void take(WireView told);
    void tell();
    QString replayText() const;

    Fleet &fleet_;
    TopicFeed feed_;
    SessionState state_;
    Freshness age_;
    QString problem_, replay_;
    QHash<QString, std::optional<QJsonObject>> orders_; ///< by method: what is to be sent after the answer
};

} // namespace hermes::desktop
