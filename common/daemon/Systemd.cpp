#include "common/daemon/Systemd.h"

#include <cstddef>
#include <cstring>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace hermes::systemd {

void notify(const QByteArray &state) {
    const QByteArray path = qgetenv("NOTIFY_SOCKET");
    sockaddr_un address{};
    if (path.size() < 2 || size_t(path.size()) >= sizeof(address.sun_path))
        return;
    const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket < 0)
        return;
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.constData(), size_t(path.size()));
    if (address.sun_path[0] == '@')
        address.sun_path[0] = '\0'; // the abstract name space
    const auto size = socklen_t(offsetof(sockaddr_un, sun_path) + size_t(path.size()));
    // Who does not read holds up no cycle; but that it is ready must be heard.
    const int wait = state == "READY=1" ? 0 : MSG_DONTWAIT;
    ::sendto(socket, state.constData(), size_t(state.size()), MSG_NOSIGNAL | wait,
             reinterpret_cast<const sockaddr *>(&address), size);
    ::close(socket);
}

bool isService() {
    return !qEnvironmentVariableIsEmpty("NOTIFY_SOCKET");
}

std::chrono::milliseconds watchdogInterval() {
    const QByteArray process = qgetenv("WATCHDOG_PID");
    if (!process.isEmpty() && process.toLongLong() != ::getpid())
        return std::chrono::milliseconds::zero();
    return std::chrono::milliseconds(qgetenv("WATCHDOG_USEC").toLongLong() / 2000);
}

} // namespace hermes::systemd
