#include "daemons/softwaretrigger/FiringLog.h"

#include "common/Log.h"

#include <QDateTime>
#include <QDir>
#include <QFileInfo>

#include <sys/stat.h>

namespace hermes {
namespace {

constexpr int mostWaiting = 1000; // rows

} // namespace

QByteArray csvField(const QString &text) {
    QByteArray field = text.toUtf8();
    if (field.contains('"') || field.contains(',') || field.contains('\n') || field.contains('\r'))
        field = '"' + field.replace("\"", "\"\"") + '"';
    return field;
}

FiringLog::FiringLog(QString folder, double fileBytes, QByteArray header)
    : folder_(std::move(folder))
    , fileBytes_(fileBytes)
    , header_(std::move(header)) {
    disk_.setMaxThreadCount(1);
    disk_.setExpiryTimeout(-1);
    disk_.start([] {}); // its thread begins here, with the priority of this one, not of who appends
}

FiringLog::~FiringLog() {
    flush();
}

void FiringLog::append(const QByteArray &row) {
    if (folder_.isEmpty())
        return;
    {
        const std::lock_guard lock(mutex_);
        if (waiting_ >= mostWaiting) {
            ++lost_;
            return;
        }
        ++waiting_;
    }
    disk_.start([this, row] { write(row); });
}

// In the thread of the disk.
void FiringLog::write(const QByteArray &row) {
    QString error;
    if (!file_.isOpen() || isRemoved() || double(file_.size() + row.size()) > fileBytes_)
        error = begin();
    if (error.isEmpty()) {
        const qint64 whole = file_.size();
        if (file_.write(row) != row.size()) {
            error = QString("cannot write %1: %2").arg(file_.fileName(), file_.errorString());
            file_.resize(whole);
            file_.seek(whole);
        }
    }
    const std::lock_guard lock(mutex_);
    --waiting_;
    ++(error.isEmpty() ? rows_ : lost_);
    if (!error.isEmpty() && error != error_)
        logError("log of firings", error);
    error_ = error;
    path_ = file_.fileName();
}

// Somebody has removed it, or its folder: rows in it would be lost.
bool FiringLog::isRemoved() const {
    struct stat status {};
    return ::fstat(file_.handle(), &status) != 0 || status.st_nlink == 0;
}

// A new file with its header; gives what is wrong.
QString FiringLog::begin() {
    file_.close();
    if (!QDir().mkpath(folder_))
        return QString("cannot make the folder %1").arg(folder_);
    const QString stem = QDir(folder_).absoluteFilePath(
        "firings-" + QDateTime::currentDateTimeUtc().toString("yyyyMMddTHHmmsszzzZ"));
    for (int number = 0; number < 1000; ++number) {
        file_.setFileName(number == 0 ? stem + ".csv" : QString("%1-%2.csv").arg(stem).arg(number));
        if (file_.open(QIODevice::WriteOnly | QIODevice::NewOnly | QIODevice::Unbuffered)) {
            if (file_.write(header_) == header_.size())
                return {};
            const QString error = QString("cannot write %1: %2").arg(file_.fileName(), file_.errorString());
            file_.remove();
            return error;
        }
        if (!QFileInfo::exists(file_.fileName()))
            break;
    }
    return QString("cannot make %1: %2").arg(file_.fileName(), file_.errorString());
}

QJsonObject FiringLog::toJson() const {
    const std::lock_guard lock(mutex_);
    return {{"folder", folder_},
            {"path", path_},
            {"rows", double(rows_)},
            {"lost", double(lost_)},
            {"error", error_}};
}

} // namespace hermes
