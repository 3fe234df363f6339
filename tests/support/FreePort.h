#pragma once

#include <QtGlobal>

#include <arpa/inet.h>
#include <random>
#include <sys/socket.h>
#include <unistd.h>

/// A port of 127.0.0.1, TCP and UDP, for a program that is yet to be started. Nobody gets it by chance: it is
/// not one of those that the system hands out, and as long as this process lives it holds the TCP port,
/// without listening, so that other tests pass it over. Programs that set SO_REUSEADDR may listen all the
/// same; until then connections are refused.
inline quint16 reservePort() {
    static std::mt19937 random{std::random_device{}()};
    const auto bound = [](int kind, quint16 port) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const int socket = ::socket(AF_INET, kind | SOCK_CLOEXEC, 0);
        if (::bind(socket, reinterpret_cast<sockaddr *>(&address), sizeof(address)) == 0)
            return socket;
        ::close(socket);
        return -1;
    };
    for (;;) {
        const auto port = std::uniform_int_distribution<quint16>(20000, 31999)(random);
        const int held = bound(SOCK_STREAM, port), datagrams = bound(SOCK_DGRAM, port);
        if (datagrams >= 0)
            ::close(datagrams);
        if (held >= 0 && datagrams >= 0) {
            const int on = 1;
            ::setsockopt(held, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on)); // from now on for others, too
            return port;
        }
        if (held >= 0)
            ::close(held);
    }
}
