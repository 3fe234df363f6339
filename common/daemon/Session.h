#pragma once

#include "common/channel/Channel.h"
#include "common/daemon/Audit.h"
#include "common/daemon/Batch.h"
#include "common/daemon/CommandRegistry.h"
#include "common/daemon/GapWatch.h"
#include "common/daemon/ReplyCache.h"
#include "common/daemon/TopicQueue.h"

#include <QObject>
#include <algorithm>

namespace hermes {

/// What one client may cost; all settable under `limits`.
struct SessionLimits {
    int frameBytes = 1 << 20;      ///< largest frame accepted
    qint64 topicBytes = 256 << 10; ///< unsent topic data, then the oldest is dropped
    qint64 replyBytes = 2 << 20;   ///< unsent replies, then the client is closed
    int batch = 1000;              ///< messages in a batch
    int pending = 32;              ///< requests not yet answered, then further ones wait
    double idle_s = 900;           ///< without a sign of life, then the client is closed
};

/// What a client has cost so far.
struct SessionCounters {
    quint64 requests = 0;
    quint64 errors = 0;  ///< error replies
    quint64 ignored = 0; ///< responses to nothing that was asked
};

/// One client of a daemon: reads requests, has them run, sends replies (those of a batch together, in the
/// order of the requests), and carries its topic messages. Urgent commands are run when they arrive, all else
/// in turns with what other clients want.
class Session : public QObject {
    Q_OBJECT
public:
    Session(quint64 id, Channel *channel, const CommandRegistry &commands, const SessionLimits &limits,
            GapWatch &gaps, Audit &audit, QObject *parent);

    quint64 id() const { return number_; }
    QString name() const;
    TopicQueue &topics() { return queue_; }
    const SessionCounters &counters() const { return counts_; }
    const CodecCounters &codecCounters() const { return channel_->codec().counters(); }
    LinkCounters linkCounters() const { return channel_->linkCounters(); }
    quint64 repeatedRequests() const { return replies_.repeats(); }
    /// What waits for it and from it.
    qint64 heldBytes() const;
    /// Closes it when it has been silent for too long.
    void checkIdle();
    /// When bytes came or went last; monotonic.
    double lastSignOfLife() const { return std::max(lastHeard_, lastWritten_); }
    /// When bytes came last; monotonic.
    double lastHeard() const { return lastHeard_; }
    void close(const QString &reason);
    /// The same, with the reason in the log.
    void expel(const QString &reason);
    /// Sends an error that answers no request, as to a client that may not stay.
    void refuse(const RpcError &error);
    /// From now on it may only call urgent commands; empty: all.
    void restrictTo(const QString &reason) { restrictedFor_ = reason; }
    bool isRestricted() const { return !restrictedFor_.isEmpty(); }
    const QString &restriction() const { return restrictedFor_; }
    /// What it may do from now on; how it could do more is told to who may not.
    void setRole(Role role, const QString &more) {
        role_ = role;
        more_ = more;
    }
    /// As the system told when it came.
    const Peer &peer() const { return who_; }
    /// Goes on in this framing after the reply to the request that is being carried out: the only one that is
    /// under way, and before the first subscription.
    Result<void> useProtocol(const QString &name);
    /// After a gap: what comes from now on is new, when nothing of the old is on its way.
    void becomeFresh();

Q_SIGNALS:
    void closed(const QString &reason);
    /// It does not speak the protocol of the channel.
    void foreign(const hermes::RpcError &error);

private:
    using Answer = std::function<void(const QJsonValue &)>; // takes undefined for "no reply"

    QString urgentName(const QByteArray &frame, const QStringList &had) const;
    bool isUrgent(const RpcMessage &message) const;
    void receive(const QJsonValue &frame);
    bool isRepeat(const QByteArray &key, const QJsonValue &frame);
    void stopAgain(const QJsonArray &batch);
    void noteStop(const QJsonValue &id);
    bool isBeforeStop(const QJsonValue &id) const;
    void begin(const QJsonArray &messages, const QByteArray &key);
    Channel::Rank rankOf(const RpcMessage &message) const;
    bool runNextOfBatch();
    void finish(const std::shared_ptr<Batch> &done);
    void end(const QString &reason);
    void process(const RpcMessage &message, const Arrival &arrived, const Answer &answer);
    void run(const RpcRequest &request, const Arrival &arrived, const Answer &answer);
    std::optional<Error> refusal(const RpcRequest &request) const;
    void updateReceiving();
    bool isOverPending() const;
    bool makeRoom();
    void send(const QJsonValue &reply, const QByteArray &key = {}, Channel::Rank rank = Channel::Rank::Usual);
    std::optional<Error> overfull() const;

    const quint64 number_;
    Channel *channel_;
    const CommandRegistry &commands_;
    const SessionLimits limits_;
    GapWatch &gaps_;
    Audit &audit_;
    TopicQueue queue_;
    ReplyCache replies_; // where requests may be repeated
    SessionCounters counts_;
    double lastHeard_ = 0;           // monotonic: bytes came
    double lastWritten_ = 0;         // the same: bytes went
    int pending_ = 0;                // requests not yet answered
    int pendingStops_ = 0;           // the same, of urgent commands
    std::optional<double> lastStop_; // the id of one that came over a line, the largest of late
    std::shared_ptr<Batch> batch_;   // not all of it has been begun
    bool batchInTurns_ = false;      // it gets its turns
    std::optional<QString> ended_;   // closed, with a batch that is still to be run
    QString restrictedFor_;
    const Peer who_;
    const QString user_; // of the same, for people
    Role role_ = Role::Observer;
    QString more_;
    quint64 freshFor_; // the count of gaps up to which it is
};

} // namespace hermes
