#pragma once

#include "common/client/Client.h"
#include "daemons/recorder/TopicPlayer.h"

#include <QMap>
#include <QSet>

namespace hermes::recorder {

/// Gives the messages of a recording to the daemons whose topics they are, which show them to their
/// subscribers: topics.replay.
class TopicReturn : public QObject {
    Q_OBJECT
public:
    /// The connection to the daemon of that name; null: it does not run.
    using Find = std::function<Client *(const QString &daemon)>;

    explicit TopicReturn(Find find)
        : find_(std::move(find)) {}
    ~TopicReturn() override { end(); }

    /// For TopicPlayer. False: the daemon has not taken those before. One that does not answer at all keeps
    /// nobody waiting.
    bool take(const RecordedMessage &message);
    /// All topics are live again. What could not be shown is told until the next message.
    void end();
    /// What could not be shown, a line for each daemon, for people.
    QStringList problems() const;

private:
    struct Target {
        QSet<QString> topics;
        int waiting = 0; ///< calls without a reply
        bool isSilent = false;
        quint64 missed = 0;
        QString why; ///< of the last

        void miss(const QString &problem) {
            ++missed;
            why = problem;
        }
    };

    void send(Client &client, const RecordedMessage &message);

    Find find_;
    QMap<QString, Target> targets_; ///< by the daemon's name
    bool isOver_ = true;
    quint64 replays_ = 0;
};

} // namespace hermes::recorder
