#include "daemons/velodynelogger/UdpReceiver.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>

namespace hermes {

namespace {

constexpr int batchSize = 32;         // datagrams a system call; a packet comes each half millisecond
constexpr int payloadCapacity = 2048; // data packets have 1206 bytes

/// Buffers of one recvmmsg().
struct Batch {
    mmsghdr headers[batchSize];
    iovec vectors[batchSize];
    sockaddr_in sources[batchSize];
    alignas(cmsghdr) char controls[batchSize][256];
    std::uint8_t payloads[batchSize][payloadCapacity];

    void prepare() {
        std::memset(headers, 0, sizeof headers);
        for (int i = 0; i < batchSize; ++i) {
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

UdpReceiver::UdpReceiver(Sink sink)
    : sink_(std::move(sink)) {}

UdpReceiver::~UdpReceiver() {
    stop();
}

std::string UdpReceiver::start(const std::string &address, std::uint16_t port, int bufferBytes) {
    stop();
    failed_ = false;
    received_ = kernelDrops_ = tooLong_ = 0;
    sockaddr_in local{};
    local.sin_family = AF_INET;
    local.sin_port = htons(port);
    if (inet_pton(AF_INET, address.c_str(), &local.sin_addr) != 1)
        return address + ": a local IPv4 address such as 0.0.0.0 expected";
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    wake_ = ::eventfd(0, EFD_CLOEXEC);
    if (socket_ < 0 || wake_ < 0)
        return fail("no UDP socket");
    setOptions(bufferBytes);
    if (::bind(socket_, reinterpret_cast<const sockaddr *>(&local), sizeof local) != 0)
        return fail("UDP port " + std::to_string(port) + " of " + address + " cannot be opened");
    socklen_t size = sizeof local;
    ::getsockname(socket_, reinterpret_cast<sockaddr *>(&local), &size);
    port_ = ntohs(local.sin_port);
    thread_ = std::thread([this] { run(); });
    return {};
}

std::string UdpReceiver::fail(const std::string &what) {
    const std::string message = what + ": " + std::strerror(errno);
    stop();
    return message;
}

void UdpReceiver::setOptions(int bufferBytes) {
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

void UdpReceiver::stop() {
    if (thread_.joinable()) {
        const std::uint64_t one = 1;
        if (::write(wake_, &one, sizeof one) == sizeof one)
            thread_.join();
        else
            std::abort(); // an eventfd that was never written to cannot be full
    }
    for (int *descriptor : {&socket_, &wake_}) {
        if (*descriptor >= 0)
            ::close(*descriptor);
        *descriptor = -1;
    }
}

void UdpReceiver::run() {
    pollfd waits[2] = {{socket_, POLLIN, 0}, {wake_, POLLIN, 0}};
    for (;;) {
        if (::poll(waits, 2, -1) < 0 && errno != EINTR)
            break;
        if (waits[1].revents)
            return;
        if (receiveBatch() < 0 && errno != EINTR && errno != EAGAIN)
            break;
    }
    error_ = "receiving on UDP port " + std::to_string(port_) + " failed: " + std::strerror(errno);
    failed_ = true;
}

int UdpReceiver::receiveBatch() {
    thread_local Batch batch;
    batch.prepare();
    const int count = ::recvmmsg(socket_, batch.headers, batchSize, MSG_DONTWAIT, nullptr);
    for (int i = 0; i < count; ++i) {
        msghdr &header = batch.headers[i].msg_hdr;
        const Annotations annotations(header);
        if (annotations.hasDrops)
            kernelDrops_ = annotations.drops;
        ++received_;
        if (header.msg_flags & MSG_TRUNC) {
            ++tooLong_;
            continue;
        }
        Datagram datagram;
        datagram.stamp_ns = annotations.stamp_ns;
        datagram.source = ntohl(batch.sources[i].sin_addr.s_addr);
        datagram.sourcePort = ntohs(batch.sources[i].sin_port);
        datagram.destination = annotations.destination;
        datagram.destinationPort = port_;
        datagram.payload = batch.payloads[i];
        datagram.size = batch.headers[i].msg_len;
        sink_(datagram);
    }
    return count;
}

UdpReceiver::Counts UdpReceiver::counts() const {
    return {received_, kernelDrops_, tooLong_, bufferBytes_};
}

} // namespace hermes
