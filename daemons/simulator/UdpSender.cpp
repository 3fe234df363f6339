#include "daemons/simulator/UdpSender.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace hermes::simulator {

Outcome<void> UdpSender::open(const std::string &host, std::uint16_t port) {
    close();
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    if (inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1)
        return host + ": an IPv4 address such as 127.0.0.1 expected";
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket_ < 0)
        return std::string("no UDP socket: ") + std::strerror(errno);
    const int on = 1;
    ::setsockopt(socket_, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
    // Connected, so that the address is not looked up for each packet. A receiver that is not there shows as
    // ECONNREFUSED of a later packet, which send() knows.
    if (::connect(socket_, reinterpret_cast<const sockaddr *>(&address), sizeof address) != 0) {
        const std::string error =
            host + ":" + std::to_string(port) + " cannot be sent to: " + std::strerror(errno);
        close();
        return error;
    }
    return {};
}

void UdpSender::close() {
    if (socket_ >= 0)
        ::close(socket_);
    socket_ = -1;
}

bool UdpSender::send(const std::uint8_t *bytes, std::size_t size) {
    ssize_t sent = ::send(socket_, bytes, size, 0);
    if (sent < 0 && errno == ECONNREFUSED) // told of an earlier packet
        sent = ::send(socket_, bytes, size, 0);
    return sent == ssize_t(size) || errno == ECONNREFUSED;
}

} // namespace hermes::simulator
