#include "common/platform/Sockets.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace hermes::sockets {

namespace {

bool bindTo(int descriptor, int family, std::uint16_t port) {
    const int on = 1, off = 0;
    ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (family == AF_INET) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        return ::bind(descriptor, reinterpret_cast<const sockaddr *>(&address), sizeof address) == 0;
    }
    ::setsockopt(descriptor, IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
    sockaddr_in6 address{};
    address.sin6_family = AF_INET6;
    address.sin6_port = htons(port);
    return ::bind(descriptor, reinterpret_cast<const sockaddr *>(&address), sizeof address) == 0;
}

// A signal does not shorten it.
int pollUntilReady(std::vector<pollfd> &ends, int most_ms) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::milliseconds(most_ms);
    for (int left_ms = most_ms;;) {
        const int ready = ::poll(ends.data(), ends.size(), left_ms);
        if (ready >= 0 || errno != EINTR)
            return ready;
        if (most_ms >= 0)
            left_ms =
                std::max(0, int(std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count()));
    }
}

} // namespace

Listening listenAt(std::uint16_t port) {
    Listening result;
    for (const int family : {AF_INET6, AF_INET}) { // the former takes both; there may be none of it
        const int descriptor = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        result.isMade = descriptor >= 0;
        if (result.isMade && bindTo(descriptor, family, port) && ::listen(descriptor, SOMAXCONN) == 0) {
            result.socket = descriptor;
            return result;
        }
        result.error = errno;
        if (!result.isMade)
            continue;
        ::close(descriptor);
        if (result.error == EADDRINUSE)
            break;
    }
    return result;
}

Socket accept(Socket listening, const std::function<void(const sockaddr *)> &take) {
    sockaddr_storage from{};
    socklen_t size = sizeof from;
    auto *const address = reinterpret_cast<sockaddr *>(&from);
    const int descriptor = ::accept4(int(listening), address, &size, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (descriptor >= 0)
        take(address);
    return descriptor;
}

bool waitFor(std::vector<Awaited> &all, int most_ms) {
    std::vector<pollfd> ends;
    for (const Awaited &one : all)
        ends.push_back({int(one.socket), short(one.toWrite ? POLLOUT : POLLIN), 0});
    const bool any = pollUntilReady(ends, most_ms) > 0;
    std::transform(ends.begin(), ends.end(), all.begin(), all.begin(), [any](const pollfd &end, Awaited one) {
        one.isReady = any && end.revents != 0;
        return one;
    });
    return any;
}

Socket duplicate(Socket socket) {
    const int descriptor = ::fcntl(int(socket), F_DUPFD_CLOEXEC, 0);
    if (descriptor >= 0)
        ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) | O_NONBLOCK);
    return descriptor;
}

void endAndClose(Socket socket) {
    ::shutdown(int(socket), SHUT_WR);
    close(socket);
}

void close(Socket socket) {
    if (socket != none)
        ::close(int(socket));
}

void askPeer(Socket socket) {
    const auto set = [descriptor = int(socket)](int level, int option, int value) {
        ::setsockopt(descriptor, level, option, &value, sizeof value);
    };
    set(SOL_SOCKET, SO_KEEPALIVE, 1);
    set(IPPROTO_TCP, TCP_KEEPIDLE, 2);
    set(IPPROTO_TCP, TCP_KEEPINTVL, 1);
    set(IPPROTO_TCP, TCP_KEEPCNT, 2);
}

bool isPeerLost(Socket socket) {
    // The system would go on for a quarter of an hour. TCP_USER_TIMEOUT would end also whom nobody reads.
    constexpr unsigned leastTries = 3, leastSilence_ms = 4000;
    tcp_info info{};
    socklen_t size = sizeof info;
    return ::getsockopt(int(socket), IPPROTO_TCP, TCP_INFO, &info, &size) == 0 &&
           std::max<unsigned>(info.tcpi_retransmits, info.tcpi_probes) >= leastTries &&
           info.tcpi_last_ack_recv >= leastSilence_ms;
}

bool hasUnread(Socket socket) {
    int unread = 0;
    return ::ioctl(int(socket), FIONREAD, &unread) == 0 && unread > 0;
}

} // namespace hermes::sockets
