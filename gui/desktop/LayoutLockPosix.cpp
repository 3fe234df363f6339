#include "gui/desktop/LayoutLock.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace hermes::desktop {

LayoutLock::~LayoutLock() {
    if (held_ >= 0)
        ::close(int(held_));
}

bool LayoutLock::take() {
    if (held_ >= 0)
        return true;
    QDir().mkpath(QFileInfo(file_).absolutePath());
    const int opened =
        ::open(QFile::encodeName(file_).constData(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (opened < 0)
        return true;
    if (::flock(opened, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        ::close(opened);
        return false;
    }
    held_ = opened;
    return true;
}

} // namespace hermes::desktop
