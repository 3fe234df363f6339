#include "common/Log.h"

#include "common/Time.h"

#include <QDateTime>
#include <QMutexLocker>
#include <algorithm>
#include <cstdio>

namespace hermes {
namespace {

void fromQt(QtMsgType type, const QMessageLogContext &context, const QString &text) {
    const LogLevel level = type == QtDebugMsg     ? LogLevel::Debug
                           : type == QtInfoMsg    ? LogLevel::Info
                           : type == QtWarningMsg ? LogLevel::Warning
                                                  : LogLevel::Failure;
    Log::instance().write(level, QLatin1String(context.category ? context.category : "qt"), text);
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

QJsonObject LogRecord::toJson() const {
    return {{QStringLiteral("stamp"), stamp},
            {QStringLiteral("level"), toString(level)},
            {QStringLiteral("source"), source},
            {QStringLiteral("text"), text}};
}

Log &Log::instance() {
    static Log log;
    return log;
}

Log::Log() {
    qRegisterMetaType<LogRecord>();
}

void Log::write(LogLevel level, const QString &source, const QString &text) {
    const LogRecord record{stampNow(), level, source, text};
    {
        const QMutexLocker lock(&mutex);
        if (level < minimum)
            return;
        records.push_back(record);
        while (int(records.size()) > capacity)
            records.pop_front();
        if (toStderr) {
            const QByteArray bytes = line(record);
            std::fwrite(bytes.constData(), 1, size_t(bytes.size()), stderr);
        }
    }
    Q_EMIT written(record);
}

QJsonArray Log::tail(int count) const {
    const QMutexLocker lock(&mutex);
    QJsonArray array;
    for (size_t i = records.size() - std::min(records.size(), size_t(std::max(count, 0))); i < records.size();
         ++i)
        array.append(records[i].toJson());
    return array;
}

void Log::setMinimumLevel(LogLevel level) {
    const QMutexLocker lock(&mutex);
    minimum = level;
}

void Log::setCapacity(int count) {
    const QMutexLocker lock(&mutex);
    capacity = std::max(count, 1);
}

void Log::setStderr(bool enabled) {
    const QMutexLocker lock(&mutex);
    toStderr = enabled;
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
