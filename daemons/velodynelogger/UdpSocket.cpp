#include "daemons/velodynelogger/UdpSocket.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>

namespace hermes::velodynelogger {

namespace {

constexpr std::size_t batchSize = 32;         // datagrams a system call; a packet comes each half millisecond
constexpr std::size_t payloadCapacity = 2048; // data packets have 1206 bytes

std::int64_t toNanoseconds(const timespec &time) {
    return std::int64_t(time.tv_sec) * 1000000000 + time.tv_nsec;
}

/// What the kernel tells beside a datagram.
struct Annotations {
    std::int64_t stamp_ns = 0;
    std::uint32_t destination = 0;
    bool hasDrops = false;
    std::uint32_t drops = 0; ///< of the socket since it was opened

    explicit Annotations(msghdr &header) {
        for (cmsghdr *c = CMSG_FIRSTHDR(&header); c; c = CMSG_NXTHDR(&header, c)) {
            if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SCM_TIMESTAMPNS) {
                timespec time;
                std::memcpy(&time, CMSG_DATA(c), sizeof time);
                stamp_ns = toNanoseconds(time);
            } else if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_RXQ_OVFL) {
                std::memcpy(&drops, CMSG_DATA(c), sizeof drops);
                hasDrops = true;
            } else if (c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_PKTINFO) {
                in_pktinfo info;
                std::memcpy(&info, CMSG_DATA(c), sizeof info);
                destination = ntohl(info.ipi_addr.s_addr);
            }
        }
        if (stamp_ns == 0) { // the kernel begins to stamp a little after it is asked to
            timespec now;
            clock_gettime(CLOCK_REALTIME, &now);
            stamp_ns = toNanoseconds(now);
        }
    }
};

} // namespace

/// Buffers of one recvmmsg(), and what came of it.
struct UdpSocket::Batch {
    mmsghdr headers[batchSize];
    iovec vectors[batchSize];
    sockaddr_in sources[batchSize];
    alignas(cmsghdr) char controls[batchSize][256];
    std::uint8_t payloads[batchSize][payloadCapacity];
    Datagram datagrams[batchSize];

    void prepare() {
        std::memset(headers, 0, sizeof headers);
        for (std::size_t i = 0; i < batchSize; ++i) {
            vectors[i] = {payloads[i], payloadCapacity};
            headers[i].msg_hdr.msg_name = &sources[i];
            headers[i].msg_hdr.msg_namelen = sizeof sources[i];
            headers[i].msg_hdr.msg_iov = &vectors[i];
            headers[i].msg_hdr.msg_iovlen = 1;
            headers[i].msg_hdr.msg_control = controls[i];
            headers[i].msg_hdr.msg_controllen = sizeof controls[i];
        }
    }
};

UdpSocket::UdpSocket()
    : batch_(std::make_unique<Batch>()) {}

UdpSocket::~UdpSocket() {
    close();
}

Outcome<void> UdpSocket::open(const std::string &address, std::uint16_t port, int bufferBytes) {
    close();
    sockaddr_in local{};
    local.sin_family = AF_INET;
    local.sin_port = htons(port);
    if (inet_pton(AF_INET, address.c_str(), &local.sin_addr) != 1)
        return address + ": a local IPv4 address such as 0.0.0.0 expected";
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket_ < 0)
        return failed("no UDP socket");
    setOptions(bufferBytes);
    if (::bind(socket_, reinterpret_cast<const sockaddr *>(&local), sizeof local) != 0)
        return failed("UDP port " + std::to_string(port) + " of " + address + " cannot be opened");
    socklen_t size = sizeof local;
    ::getsockname(socket_, reinterpret_cast<sockaddr *>(&local), &size);
    port_ = ntohs(local.sin_port);
    return {};
}

std::string UdpSocket::failed(const std::string &what) {
    const std::string message = what + ": " + std::strerror(errno);
    close();
    return message;
}

void UdpSocket::setOptions(int bufferBytes) {
    // The first needs a privilege and goes beyond the limit of the system, the second does not.
    if (::setsockopt(socket_, SOL_SOCKET, SO_RCVBUFFORCE, &bufferBytes, sizeof bufferBytes) != 0)
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &bufferBytes, sizeof bufferBytes);
    socklen_t size = sizeof bufferBytes_;
    ::getsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &bufferBytes_, &size);
    const int on = 1;
    ::setsockopt(socket_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
    ::setsockopt(socket_, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
    ::setsockopt(socket_, IPPROTO_IP, IP_PKTINFO, &on, sizeof on);
}

void UdpSocket::close() {
    if (socket_ >= 0)
        ::close(socket_);
    socket_ = -1;
    port_ = 0;
    count_ = cut_ = 0;
    drops_ = allDrops_ = 0;
}

bool UdpSocket::receive() {
    count_ = cut_ = 0;
    drops_ = 0;
    batch_->prepare();
    const int received = ::recvmmsg(socket_, batch_->headers, batchSize, MSG_DONTWAIT, nullptr);
    full_ = received == int(batchSize);
    if (received < 0)
        return errno == EINTR || errno == EAGAIN;
    for (std::size_t i = 0; i < std::size_t(received); ++i) {
        msghdr &header = batch_->headers[i].msg_hdr;
        const Annotations annotations(header);
        if (annotations.hasDrops) {
            drops_ += annotations.drops - allDrops_;
            allDrops_ = annotations.drops;
        }
        if (header.msg_flags & MSG_TRUNC) {
            ++cut_;
            continue;
        }
        Datagram &datagram = batch_->datagrams[count_++];
        datagram.stamp_ns = annotations.stamp_ns;
        datagram.source = ntohl(batch_->sources[i].sin_addr.s_addr);
        datagram.sourcePort = ntohs(batch_->sources[i].sin_port);
        datagram.destination = annotations.destination;
        datagram.destinationPort = port_;
        datagram.payload = batch_->payloads[i];
        datagram.size = batch_->headers[i].msg_len;
    }
    return true;
}

const Datagram &UdpSocket::datagram(std::size_t i) const {
    return batch_->datagrams[i];
}

} // namespace hermes::velodynelogger
