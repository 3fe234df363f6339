#pragma once

#include "gui/desktop/model/LoggerWatch.h"
#include "gui/session/SessionRecorder.h"

namespace hermes::desktop {

/// Ends what the robot records: each logger is told at once, and again until it has answered, for as long as
/// it takes. One that is gone is not waited for, but told when it comes back and still records.
class RecordingStop : public QObject {
    Q_OBJECT
public:
    explicit RecordingStop(LoggerWatch &watch, QObject *parent = nullptr);

    void begin();
    /// A new recording begins: none of before is to end any more.
    void forget() { sessions_.clear(); }
    bool isUnderWay() const { return isUnderWay_; }
    /// Who has not answered as yet.
    QStringList waitingFor() const;

Q_SIGNALS:
    /// All have answered; what is missing, or does not agree.
    void ended(const QStringList &problems);

private:
    std::vector<SessionMember> unanswered() const;
    void goOn();
    void take(const QString &address, const SessionReply &reply);
    void check();

    LoggerWatch &watch_;
    SessionRecorder recorder_;
    QSet<QString> sessions_;             ///< that were to end
    QSet<QString> told_, answered_;      ///< the addresses of loggers
    QMap<QString, QString> unconfirmed_; ///< names of those that were told and gave no answer, by address
    SessionReplies ends_;
    bool isUnderWay_ = false, checks_ = false;
};

} // namespace hermes::desktop
