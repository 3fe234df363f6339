#include "common/Log.h"

#include "common/Time.h"

#include <QDateTime>
#include <algorithm>
#include <climits>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace hermes {
namespace {

constexpr int longestText = 4000; // characters

// Begun without standard streams, the first device that is opened would be "stderr" and get the log. Before
// main(), as Qt opens files of its own.
const bool hasStandardStreams = [] {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
        if (::fcntl(stream, F_GETFD) < 0 && ::open("/dev/null", O_RDWR) != stream)
            return false;
    }
    return true;
}();

void fromQt(QtMsgType type, const QMessageLogContext &context, const QString &text) {
    const LogLevel level = type == QtDebugMsg     ? LogLevel::Debug
                           : type == QtInfoMsg    ? LogLevel::Info
                           : type == QtWarningMsg ? LogLevel::Warning
                                                  : LogLevel::Failure;
    Log::instance().write(level, QLatin1String(context.category ? context.category : "qt"), text);
}

/// What others have named may stand in it: nothing that begins a line or moves a terminal's cursor.
QString oneLine(const QString &text) {
    QString line;
    for (const QChar c : text.left(longestText)) {
        const bool isControl = c.category() == QChar::Other_Control || c.category() == QChar::Other_Format ||
                               c == QChar::LineSeparator || c == QChar::ParagraphSeparator;
        line += isControl ? QStringLiteral("\\u%1").arg(c.unicode(), 4, 16, QLatin1Char('0')) : QString(c);
    }
    if (text.size() > longestText)
        line += QStringLiteral("... (%1 characters)").arg(text.size());
    return line;
}

QByteArray line(const LogRecord &record) {
    const QDateTime time = QDateTime::fromMSecsSinceEpoch(qint64(record.stamp * 1000)).toUTC();
    return QStringLiteral("%1 %2 %3: %4\n")
        .arg(time.toString(Qt::ISODateWithMs), toString(record.level), record.source, record.text)
        .toUtf8();
}

} // namespace

QString toString(LogLevel level) {
    static const char *const names[] = {"debug", "info", "warning", "error"};
    return QLatin1String(names[int(level)]);
}

LogMessage LogRecord::message() const {
    return {stamp, toString(level), source, text};
}

Log &Log::instance() {
    static Log log;
    return log;
}

// Never waits for whoever reads stderr: a terminal that was stopped must not stop the daemon.
void Log::writeToStderr(QByteArray bytes) {
    if (lostLines_ > 0)
        bytes.prepend(QStringLiteral("(%1 lines of the log are missing here: stderr did not take them)\n")
                          .arg(lostLines_)
                          .toUtf8());
    while (!bytes.isEmpty()) {
        pollfd output{STDERR_FILENO, POLLOUT, 0};
        const bool ready = ::poll(&output, 1, 0) == 1 && (output.revents & POLLOUT);
        const size_t size = std::min(size_t(bytes.size()), size_t(PIPE_BUF)); // so much is written at once
        const ssize_t written = ready ? ::write(STDERR_FILENO, bytes.constData(), size) : -1;
        if (written <= 0) {
            ++lostLines_;
            return;
        }
        bytes.remove(0, int(written));
    }
    lostLines_ = 0;
}

void Log::write(LogLevel level, const QString &source, const QString &text) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (level < minimum_)
        return;
    const LogRecord record{stampNow(), level, source, oneLine(text)};
    records_.push_back(record);
    while (int(records_.size()) > capacity_)
        records_.pop_front();
    if (toStderr_ && hasStandardStreams)
        writeToStderr(line(record));
    for (const auto &[who, take] : followers_)
        QMetaObject::invokeMethod(
            who, [take = take, record] { take(record); }, Qt::QueuedConnection);
}

void Log::pass(const QString &program, const QString &text) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (toStderr_ && hasStandardStreams)
        writeToStderr((program + QStringLiteral(": ") + oneLine(text) + QLatin1Char('\n')).toUtf8());
}

void Log::follow(QObject *who, const std::function<void(const LogRecord &)> &take) {
    const std::lock_guard<std::mutex> lock(mutex_);
    followers_[who] = take;
}

void Log::unfollow(QObject *who) {
    const std::lock_guard<std::mutex> lock(mutex_);
    followers_.erase(who);
}

std::vector<LogMessage> Log::tail(int count) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    constexpr qint64 besideText = 100; // of a record, as JSON
    size_t first = records_.size();
    for (qint64 size = 0; first > 0 && size < maxTailBytes && int(records_.size() - first) < count; --first)
        size += records_[first - 1].text.size() + besideText;
    std::vector<LogMessage> last;
    for (size_t i = first; i < records_.size(); ++i)
        last.push_back(records_[i].message());
    return last;
}

void Log::setMinimumLevel(LogLevel level) {
    const std::lock_guard<std::mutex> lock(mutex_);
    minimum_ = level;
}

void Log::setCapacity(int count) {
    const std::lock_guard<std::mutex> lock(mutex_);
    capacity_ = std::max(count, 1);
}

void Log::setStderr(bool enabled) {
    const std::lock_guard<std::mutex> lock(mutex_);
    toStderr_ = enabled;
}

void Log::captureQtMessages() {
    qInstallMessageHandler(fromQt);
}

void logDebug(const QString &source, const QString &text) {
    Log::instance().write(LogLevel::Debug, source, text);
}
void logInfo(const QString &source, const QString &text) {
    Log::instance().write(LogLevel::Info, source, text);
}
void logWarning(const QString &source, const QString &text) {
    Log::instance().write(LogLevel::Warning, source, text);
}
void logError(const QString &source, const QString &text) {
    Log::instance().write(LogLevel::Failure, source, text);
}

} // namespace hermes
