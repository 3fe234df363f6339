#pragma once

#include <cstdint>
#include <functional>
#include <vector>

struct sockaddr;

namespace hermes {

/// Sockets of the system where Qt's do not do: without an event loop, and for OpenSSL.
namespace sockets {

using Socket = std::intptr_t;
constexpr Socket none = -1;

/// Listens at a port of all addresses, IPv6 with IPv4 where there is IPv6. Without a socket `error` tells
/// why.
struct Listening {
    Socket socket = none;
    int error = 0;       ///< of the system
    bool isMade = false; ///< a socket was made, but the port cannot be had
};
Listening listenAt(std::uint16_t port);

/// The next who has connected, if anybody; take gets its address. It never waits.
Socket accept(Socket listening, const std::function<void(const sockaddr *)> &take);

/// One that is to be waited for.
struct Awaited {
    Socket socket = none;
    bool toWrite = false; ///< to be written to, instead of read
    bool isReady = false; ///< or failed
};
/// Waits until one is ready, milliseconds at most, without end where they are negative; false: none is.
bool waitFor(std::vector<Awaited> &all, int most_ms);

/// Another handle of the same connection, which never waits.
Socket duplicate(Socket socket);
/// What was written arrives, and then the end; bytes unread are lost.
void endAndClose(Socket socket);
void close(Socket socket);
/// The system asks a peer of TCP that says nothing whether it is there, and ends a connection without an
/// answer within 5 s.
void askPeer(Socket socket);
/// Whether the peer of TCP answers nothing that was sent to it, for 4 s and more. Not one who does not read:
/// its system answers.
bool isPeerLost(Socket socket);
/// Whether bytes have come that were not read.
bool hasUnread(Socket socket);

} // namespace sockets

} // namespace hermes
