#include "daemons/softwaretrigger/FiringLog.h"
#include "common/Log.h"
#include "common/files/Folder.h"

#include <QDateTime>
#include <QDir>
#include <QFileInfo>

#include <sys/stat.h>

namespace hermes::softwaretrigger {

namespace {

constexpr int maxWaiting = 1000; // rows

} // namespace

QByteArray csvField(const QString &text) {
    QByteArray field = text.toUtf8();
    if (field.contains('"') || field.contains(',') || field.contains('\n') || field.contains('\r'))
        field = '"' + field.replace("\"", "\"\"") + '"';
    return field;
}

FiringLog::FiringLog(QString folder, double fileBytes, QByteArray header)
    : fileBytes_(fileBytes)
    , header_(std::move(header)) {
    state_.folder = std::move(folder);
    disk_.setMaxThreadCount(1);
    disk_.setExpiryTimeout(-1);
    disk_.start([] {}); // its thread begins here, with the priority of this one, not of who appends
}

FiringLog::~FiringLog() {
    flush();
}

void FiringLog::append(const QByteArray &row) {
    if (state_.folder.isEmpty())
        return;
    {
        const std::lock_guard lock(mutex_);
        if (waiting_ >= maxWaiting) {
            ++state_.lost;
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
    ++(error.isEmpty() ? state_.rows : state_.lost);
    if (!error.isEmpty() && error != state_.error)
        logError("log of firings", error);
    state_.error = error;
    state_.path = file_.fileName();
}

// A new file with its header; gives what is wrong.
QString FiringLog::begin() {
    file_.close();
    const QString &folder = state_.folder; // does not change
    if (const Result<void> made = makeFolder(folder); !made)
        return made.error().message;
    const QString stem = QDir(folder).absoluteFilePath(
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

bool FiringLog::isRemoved() const {
    struct stat status {};
    return ::fstat(file_.handle(), &status) != 0 || status.st_nlink == 0;
}

} // namespace hermes::softwaretrigger
