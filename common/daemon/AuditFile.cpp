#include "common/daemon/AuditFile.h"

#include "common/Result.h"
#include "common/Time.h"
#include "common/files/Folder.h"

#include <QDir>
#include <QFile>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <fcntl.h>
#include <mutex>
#include <sys/file.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace hermes {
namespace {

constexpr std::chrono::seconds longestFarewell{1};

} // namespace

struct AuditFile::Shared {
    const QString folder;
    const QString name;
    const qint64 bytes;
    const int files;

    mutable std::mutex mutex;
    std::condition_variable changed;
    std::deque<QByteArray> waiting;
    State state;
    bool isBusy = false;
    bool isOver = false;

    QByteArray path(int number) const {
        const QString file = number == 0 ? name : QStringLiteral("%1.%2").arg(name).arg(number);
        return QFile::encodeName(QDir(folder).filePath(file + QStringLiteral(".jsonl")));
    }

    void lose(const QString &why) {
        ++state.lost;
        state.problem = why;
        state.lostAt = monotonicNow();
    }

    void work() {
        std::unique_lock<std::mutex> lock(mutex);
        while (true) {
            changed.wait(lock, [this] { return isOver || !waiting.empty(); });
            if (waiting.empty())
                return;
            const QByteArray line = std::move(waiting.front()) + '\n';
            waiting.pop_front();
            isBusy = true;
            lock.unlock();
            const QString problem = write(line);
            lock.lock();
            isBusy = false;
            if (problem.isEmpty())
                ++state.written;
            else
                lose(problem);
            changed.notify_all();
        }
    }

    // Why not; empty: it was written.
    QString write(const QByteArray &line) const {
        if (const Result<void> made = makeFolder(folder); !made)
            return made.error().message;
        constexpr int rights = 0600;
        const int file = ::open(path(0).constData(),
                                O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, rights);
        if (file < 0)
            return QFile::decodeName(path(0)) + QStringLiteral(": ") + qt_error_string(errno);
        const auto closed = std::shared_ptr<void>(nullptr, [file](void *) { ::close(file); });
        struct stat status {};
        if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode))
            return QFile::decodeName(path(0)) + QStringLiteral(": is not a file");
        const ssize_t written = ::write(file, line.constData(), std::size_t(line.size()));
        if (written != line.size()) {
            const QString why = written < 0 ? qt_error_string(errno) : QStringLiteral("the disk is full");
            if (written > 0 && ::ftruncate(file, status.st_size) != 0)
                return QFile::decodeName(path(0)) + QStringLiteral(": half a line was written, ") + why;
            return QFile::decodeName(path(0)) + QStringLiteral(": ") + why;
        }
        if (status.st_size + written >= bytes)
            rotate(file);
        return {};
    }

    // Another process may do it at the same time: who finds another file of that name leaves it.
    void rotate(int file) const {
        if (::flock(file, LOCK_EX) != 0)
            return;
        struct stat mine {
        }, named{};
        if (::fstat(file, &mine) != 0 || ::stat(path(0).constData(), &named) != 0 ||
            mine.st_ino != named.st_ino)
            return;
        for (int i = files - 1; i > 0; --i)
            ::rename(path(i - 1).constData(), path(i).constData());
        if (files <= 1)
            ::unlink(path(0).constData());
    }
};

AuditFile::AuditFile(const QString &folder, const QString &name, qint64 bytes, int files)
    : shared_(new Shared{folder, name, bytes, files, {}, {}, {}, {}, false, false}) {
    std::thread([shared = shared_] { shared->work(); }).detach();
}

AuditFile::~AuditFile() {
    std::unique_lock<std::mutex> lock(shared_->mutex);
    shared_->isOver = true;
    shared_->changed.notify_all();
    shared_->changed.wait_for(lock, longestFarewell,
                              [this] { return shared_->waiting.empty() && !shared_->isBusy; });
}

void AuditFile::append(const QByteArray &line) {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    if (shared_->waiting.size() >= maxWaiting) {
        shared_->lose(QStringLiteral("the disk is too slow"));
        return;
    }
    shared_->waiting.push_back(line);
    shared_->changed.notify_all();
}

bool AuditFile::isSlow() const {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    return shared_->waiting.size() > maxWaiting / 2;
}

AuditFile::State AuditFile::state() const {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    return shared_->state;
}

QString AuditFile::path() const {
    return QFile::decodeName(shared_->path(0));
}

} // namespace hermes
