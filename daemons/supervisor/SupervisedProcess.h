#pragma once

#include "daemons/supervisor/ProcessGuard.h"
#include "protocol/messages/Processes.h"

#include <QJsonArray>
#include <QObject>
#include <QProcess>
#include <QTimer>
#include <deque>
#include <memory>
#include <sys/types.h>

namespace hermes::supervisor {

/// One process that is kept running. When it ends by itself with an error it is started again, after a
/// back-off that doubles; a wrong command line (exit status 2) is not tried again before the entry changes,
/// nor is an end in order (0). It ends with the supervisor, however that ends. Of what it writes, 100 lines a
/// second go to the log.
class SupervisedProcess : public QObject {
    Q_OBJECT
public:
    enum class State { Stopped, Running, Stopping, Waiting, Failed };
    static constexpr std::chrono::milliseconds firstBackOff{500}, longestBackOff{30000}, killAfter{5000};
    /// Having run so long it is well: the next back-off is the first again.
    static constexpr std::chrono::milliseconds wellAfter{10000};
    static constexpr std::size_t keptLines = 200;

    /// guard: ends it when the supervisor is killed; may be null.
    explicit SupervisedProcess(const ProcessEntry &entry, std::shared_ptr<ProcessGuard> guard = {},
                               QObject *parent = nullptr);
    ~SupervisedProcess() override;

    /// Where a program is: beside the supervisor first, so that an installation that is not in PATH finds its
    /// own.
    static QString found(const QString &program);

    const ProcessEntry &entry() const { return entry_; }
    /// With what is new a running process is started again, and so is one that failed or waits, at once.
    void setEntry(const ProcessEntry &entry);
    State state() const { return state_; }
    bool isAlive() const { return process_.state() != QProcess::NotRunning; }

    void start();
    /// SIGTERM, and SIGKILL after killAfter.
    void stop();
    void restart();
    /// Counts what it was told: whether somebody has told it something meanwhile.
    int orders() const { return orders_; }

    /// Looks how much of a core (since the last time) and how much memory it uses.
    void measure();
    ProcessStatus status() const;
    const QString &lastExit() const { return lastExit_; }
    /// The last lines that it wrote to stdout and stderr, oldest first; also one that is not ended.
    QStringList output(int lines) const;

Q_SIGNALS:
    void changed();

private:
    /// Ends with its parent even when that is killed.
    class Child : public QProcess {
    protected:
        void setupChildProcess() override;
    };

    void onEnded(int code, QProcess::ExitStatus status);
    void onFailedToStart();
    void retryLater();
    void readOutput();
    void keepLine(const QByteArray &line);
    void passLine(const QString &line);
    /// Those that it started and left behind.
    void endFamily();
    void setState(State state);

    ProcessEntry entry_;
    const std::shared_ptr<ProcessGuard> guard_;
    Child process_;
    State state_ = State::Stopped;
    const QString family_;
    pid_t group_ = 0;
    QTimer retry_, kill_;
    std::chrono::milliseconds backOff_ = firstBackOff;
    int restarts_ = 0, orders_ = 0;
    double started_ = 0; // monotonic
    bool startAfterStop_ = false;
    QString lastExit_;
    std::deque<QString> lines_;
    QByteArray partialLine_;
    double mayPass_ = 0, passed_ = 0; // lines for the log; when the last was looked at, monotonic
    quint64 leftOut_ = 0;
    double measured_ = 0, used_s_ = 0, cpu_ = 0;
    qint64 memory_bytes_ = 0;
};

QString toString(SupervisedProcess::State state);

/// What a supervisor runs unless its settings say otherwise: all daemons but itself, when they are started.
QJsonArray usualProcesses();

} // namespace hermes::supervisor
