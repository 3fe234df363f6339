#pragma once

#include "common/Result.h"

#include <QFile>

#include <cstddef>
#include <cstring>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace hermes {

/// The address of a Unix socket: a path of at most 107 bytes; one that begins with @ is an abstract name,
/// which belongs to the network namespace as a port does: unix(7).
class LocalAddress {
public:
    static Result<LocalAddress> of(const QString &path) {
        const QByteArray name = QFile::encodeName(path);
        LocalAddress made;
        if (name.isEmpty() || name.contains('\0') ||
            std::size_t(name.size()) >= sizeof made.address_.sun_path)
            return Error(ErrorCode::InvalidParams,
                         QString("the path of a socket has 1 to %1 bytes, \"%2\" has %3")
                             .arg(sizeof made.address_.sun_path - 1)
                             .arg(path.left(200))
                             .arg(name.size()));
        made.address_.sun_family = AF_UNIX;
        std::memcpy(made.address_.sun_path, name.constData(), std::size_t(name.size()));
        made.size_ = sizeof made.address_;
        if (name.startsWith('@')) {
            made.address_.sun_path[0] = '\0';
            made.size_ = socklen_t(offsetof(sockaddr_un, sun_path) + std::size_t(name.size()));
        }
        return made;
    }
    const sockaddr *get() const { return reinterpret_cast<const sockaddr *>(&address_); }
    socklen_t size() const { return size_; }
    bool isFile() const { return address_.sun_path[0] != '\0'; }
    const char *path() const { return address_.sun_path; }

    /// Does not wait.
    static int makeSocket() { return ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0); }
    static void closeSocket(int descriptor) {
        if (descriptor >= 0)
            ::close(descriptor);
    }

private:
    sockaddr_un address_{};
    socklen_t size_ = 0;
};

} // namespace hermes
