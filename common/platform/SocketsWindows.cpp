#include "common/platform/Sockets.h"

// In this order.
#include <winsock2.h>
#include <ws2tcpip.h>

#include <algorithm>

namespace hermes::sockets {

namespace {

bool begin() {
    WSADATA data;
    static const bool begun = ::WSAStartup(MAKEWORD(2, 2), &data) == 0; // Qt does so, too: they are counted
    return begun;
}

void neverWait(SOCKET socket) {
    u_long on = 1;
    ::ioctlsocket(socket, FIONBIO, &on);
}

void set(SOCKET socket, int level, int name, DWORD value) {
    ::setsockopt(socket, level, name, reinterpret_cast<const char *>(&value), sizeof value);
}

// SO_REUSEADDR of Windows would let two programs have the same port.
bool bindTo(SOCKET socket, int family, std::uint16_t port) {
    set(socket, SOL_SOCKET, SO_EXCLUSIVEADDRUSE, 1);
    if (family == AF_INET) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = ::htons(port);
        return ::bind(socket, reinterpret_cast<const sockaddr *>(&address), sizeof address) == 0;
    }
    set(socket, IPPROTO_IPV6, IPV6_V6ONLY, 0);
    sockaddr_in6 address{};
    address.sin6_family = AF_INET6;
    address.sin6_port = ::htons(port);
    return ::bind(socket, reinterpret_cast<const sockaddr *>(&address), sizeof address) == 0;
}

} // namespace

Listening listenAt(std::uint16_t port) {
    Listening result;
    for (const int family : {AF_INET6, AF_INET}) { // the former takes both; there may be none of it
        const SOCKET socket = begin() ? ::socket(family, SOCK_STREAM, 0) : INVALID_SOCKET;
        result.isMade = socket != INVALID_SOCKET;
        if (result.isMade && bindTo(socket, family, port) && ::listen(socket, SOMAXCONN) == 0) {
            neverWait(socket);
            result.socket = Socket(socket);
            return result;
        }
        result.error = ::WSAGetLastError();
        if (!result.isMade)
            continue;
        ::closesocket(socket);
        if (result.error == WSAEADDRINUSE || result.error == WSAEACCES)
            break;
    }
    return result;
}

Socket accept(Socket listening, const std::function<void(const sockaddr *)> &take) {
    sockaddr_storage from{};
    int size = sizeof from;
    auto *const address = reinterpret_cast<sockaddr *>(&from);
    const SOCKET socket = ::accept(SOCKET(listening), address, &size);
    if (socket == INVALID_SOCKET)
        return none;
    neverWait(socket);
    take(address);
    return Socket(socket);
}

bool waitFor(std::vector<Awaited> &all, int most_ms) {
    std::vector<WSAPOLLFD> ends;
    for (const Awaited &one : all)
        ends.push_back({SOCKET(one.socket), SHORT(one.toWrite ? POLLOUT : POLLIN), 0});
    const bool any = ::WSAPoll(ends.data(), ULONG(ends.size()), most_ms) > 0;
    std::transform(ends.begin(), ends.end(), all.begin(), all.begin(),
                   [any](const WSAPOLLFD &end, Awaited one) {
                       one.isReady = any && end.revents != 0;
                       return one;
                   });
    return any;
}

Socket duplicate(Socket socket) {
    WSAPROTOCOL_INFOW info;
    if (::WSADuplicateSocketW(SOCKET(socket), ::GetCurrentProcessId(), &info) != 0)
        return none;
    const SOCKET copy = ::WSASocketW(FROM_PROTOCOL_INFO, FROM_PROTOCOL_INFO, FROM_PROTOCOL_INFO, &info, 0, 0);
    if (copy == INVALID_SOCKET)
        return none;
    neverWait(copy);
    return Socket(copy);
}

void endAndClose(Socket socket) {
    ::shutdown(SOCKET(socket), SD_SEND);
    close(socket);
}

void close(Socket socket) {
    if (socket != none)
        ::closesocket(SOCKET(socket));
}

void askPeer(Socket socket) {
    const DWORD on = 1;
    ::setsockopt(SOCKET(socket), SOL_SOCKET, SO_KEEPALIVE, reinterpret_cast<const char *>(&on), sizeof on);
}

bool isPeerLost(Socket) {
    return false; // the system ends it itself, after 20 s
}

bool hasUnread(Socket socket) {
    u_long unread = 0;
    return ::ioctlsocket(SOCKET(socket), FIONREAD, &unread) == 0 && unread > 0;
}

} // namespace hermes::sockets
