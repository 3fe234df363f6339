#pragma once

#include "protocol/messages/Daemons.h"

#include <QObject>
#include <deque>
#include <functional>
#include <map>
#include <mutex>

namespace hermes {

enum class LogLevel { Debug, Info, Warning, Failure };

QString toString(LogLevel level);

/// One line of the log.
struct LogRecord {
    double stamp = 0; ///< seconds since the Unix epoch
    LogLevel level = LogLevel::Info;
    QString source; ///< what spoke: a subsystem, or a Qt category
    QString text;

    LogMessage message() const;
};

/// The log of this process: keeps the last records in memory, writes them to stderr with their stamp as far
/// as it takes them, tells listeners. Any thread may write. Qt's own messages (qWarning ...) arrive here
/// after captureQtMessages().
class Log {
public:
    static constexpr qint64 maxTailBytes = 1 << 20; ///< that tail() gives, to write more takes too long

    static Log &instance();

    void write(LogLevel level, const QString &source, const QString &text);

    /// A line that another program wrote goes to stderr, too, after its name; it is no record.
    void pass(const QString &program, const QString &text);

    /// The last count records, oldest first; fewer where they would be larger than a mebibyte.
    std::vector<LogMessage> tail(int count) const;

    void setMinimumLevel(LogLevel level);
    void setCapacity(int records);
    void setStderr(bool enabled);
    void captureQtMessages();

    /// Calls take in the thread of `who`, from its event loop, with each record written from now on.
    void follow(QObject *who, const std::function<void(const LogRecord &)> &take);
    /// To be called before `who` is destroyed.
    void unfollow(QObject *who);

private:
    Log() = default;
    void writeToStderr(QByteArray bytes);

    mutable std::mutex mutex_;
    std::deque<LogRecord> records_;
    std::map<QObject *, std::function<void(const LogRecord &)>> followers_;
    int capacity_ = 1000;
    LogLevel minimum_ = LogLevel::Info;
    bool toStderr_ = true;
    quint64 lostLines_ = 0; // not taken by stderr since the last one that was
};

/// Shorthands: `logWarning("sensor", "no packet for 2 s")`.
void logDebug(const QString &source, const QString &text);
void logInfo(const QString &source, const QString &text);
void logWarning(const QString &source, const QString &text);
void logError(const QString &source, const QString &text);

} // namespace hermes
