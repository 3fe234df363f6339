#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QJsonArray>
#include <QTimer>
#include <deque>

namespace hermes {

/// Records with all loggers of the chosen robot as one session with one name: those daemons that have the
/// command record.start. All of them start, or none does.
class SessionRecorder : public QObject {
    Q_OBJECT
public:
    /// Of each logger, the newest so many recordings are listed.
    static constexpr int mostRecordings = 200;

    explicit SessionRecorder(Fleet &fleet, QObject *parent = nullptr);

    /// One logger: its daemon and what record.status says.
    struct Logger {
        QPointer<DaemonLink> daemon;
        QJsonObject status;

        bool isRecording() const { return status["recording"].toBool(); }
        /// The sum of what is missing for any reason.
        double losses() const;
    };
    const std::vector<Logger> &loggers() const { return loggers_; }
    /// Recordings of all loggers, the latest first: {name, start, end, bytes, complete, parts: [{logger,
    /// folder, files}]}.
    const QJsonArray &sessions() const { return sessions_; }
    /// Older recordings than the newest of a logger that are in the list.
    int unlisted() const { return unlisted_; }

    bool isRecording() const;
    QString name() const;
    double bytes() const;
    double seconds() const;
    /// Bytes a second, of the last ten seconds; 0: not known yet.
    double rate() const;
    /// Seconds until the fullest disk is full at that rate; negative: not known.
    double secondsLeft() const;

    void start(const QString &name);
    void stop();
    /// Asks the loggers for their lists anew.
    void list();

Q_SIGNALS:
    void changed();
    /// What was done, or what was refused by whom and why.
    void told(const QString &text, bool isError);

private:
    void follow();
    void poll();
    void undo(const std::vector<QPointer<DaemonLink>> &started);

    Fleet &fleet_;
    QTimer timer_;
    std::vector<Logger> loggers_;
    QJsonArray sessions_;
    int unlisted_ = 0;
    std::deque<std::pair<double, double>> progress_; // monotonic seconds, bytes
};

} // namespace hermes
