#pragma once

#include <QByteArray>

#include <algorithm>
#include <cerrno>
#include <unistd.h>

namespace hermes {

/// Writes all of it to a descriptor, however many calls that takes, but not yet to the disk. False: errno
/// says why, and some of it may be written.
inline bool writeAll(int file, const QByteArray &bytes) {
    qsizetype done = 0;
    while (done < bytes.size()) {
        const ssize_t written = ::write(file, bytes.constData() + done, size_t(bytes.size() - done));
        if (written < 0 && errno != EINTR)
            return false;
        done += std::max<ssize_t>(written, 0);
    }
    return true;
}

} // namespace hermes
