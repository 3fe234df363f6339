#pragma once

#include "gui/desktop/model/LoggerWatch.h"
#include "gui/session/SessionRecorder.h"

namespace hermes::desktop {

/// Ends what one robot records, whichever robot is chosen meanwhile: each logger is told at once, and again
/// until it has answered, for as long as it takes. One that is gone is not waited for, but told when it comes
/// back and still records. What is begun later goes on.
class RecordingStop : public QObject {
    Q_OBJECT
public:
    /// title: of the robot, for people.
    RecordingStop(Fleet &fleet, const QString &title, QObject *parent = nullptr);

    /// All that the watch knows to be under way is to end, too.
    void begin(const LoggerWatch &watch);
    /// A session that could not be begun whole: who has begun it all the same is to end it.
    void expect(const QString &session, const QString &address, const SessionMember &logger);
    bool isUnderWay() const { return isToCheck_ || isChecking_; }
    bool ends(const QString &session) const { return sessions_.contains(session); }
    bool isOf(const Robot *robot) const;
    const QString &title() const { return title_; }
    /// Who has not answered as yet, and answers nothing else either.
    QStringList silent() const;

Q_SIGNALS:
    void changed();
    /// All have answered; what is missing, or does not agree.
    void ended(const QStringList &problems);
    /// Its loggers are no robot's any more. doubt: some may still record.
    void removed(bool doubt);

private:
    enum class State { Told, Unconfirmed, Answered };
    /// Who was told to stop.
    struct Logger {
        SessionMember member;
        State state = State::Told;
        std::optional<Result<QJsonValue>> end; ///< that is to be compared with its sidecar
    };

    std::vector<Robot *> robots() const;
    void resume();
    void ask(const QString &address, const SessionMember &member);
    bool mayBeAsked(const QString &address) const;
    void take(const QString &address, const SessionMember &member, const QJsonObject &state);
    void tell(const QString &address, const SessionMember &member, const QJsonValue &session);
    void take(Logger &logger, const Result<QJsonValue> &reply);
    bool isWaitedFor(const QString &address, const Logger &logger) const;
    void checkWhenAnswered();
    SessionReplies takeEnds(const SessionMembers &members);

    Fleet &fleet_;
    const QString title_;
    QTimer timer_;
    SessionRecorder recorder_;
    QSet<QString> sessions_;            ///< that are to end
    std::map<QString, Logger> loggers_; ///< by address
    QSet<QString> asked_;               ///< the addresses of loggers that are asked what they record
    bool isToCheck_ = false, isChecking_ = false;
    bool tells_ = false; ///< somebody pressed Stop and waits for what becomes of it
};

} // namespace hermes::desktop
