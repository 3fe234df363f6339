#include "gui/hermesctl/PairingServer.h"

#include <QHostAddress>
#include <QNetworkInterface>
#include <algorithm>
#include <cerrno>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace hermes::ctl {
namespace {

constexpr std::chrono::seconds longestHandshake{5};
constexpr std::size_t mostGuests = 64; // at the same time, then the oldest goes
constexpr int waitingPeriod_ms = 250;

bool bindTo(int descriptor, int family, quint16 port) {
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

QString textOf(const sockaddr_storage &from) {
    const QHostAddress address(reinterpret_cast<const sockaddr *>(&from));
    bool isMapped = false;
    const quint32 four = address.toIPv4Address(&isMapped);
    return isMapped ? QHostAddress(four).toString() : address.toString();
}

} // namespace

PairingServer::~PairingServer() {
    close();
}

void PairingServer::close() {
    guests_.clear();
    if (listening_ >= 0)
        ::close(listening_);
    listening_ = -1;
}

Result<void> PairingServer::listen(quint16 port) {
    for (const int family : {AF_INET6, AF_INET}) { // the former takes both; there may be none of it
        listening_ = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        if (listening_ >= 0 && bindTo(listening_, family, port) && ::listen(listening_, SOMAXCONN) == 0)
            return {};
        if (listening_ < 0)
            continue;
        const int why = errno;
        close();
        if (why == EADDRINUSE || family == AF_INET)
            return Error(ErrorCode::InputOutput,
                         QStringLiteral("cannot wait on port %1: %2; take another one with --port")
                             .arg(port)
                             .arg(qt_error_string(why)));
    }
    return Error(ErrorCode::InputOutput, QStringLiteral("no socket can be made: ") + qt_error_string(errno));
}

Result<PairingServer::Joined> PairingServer::wait(std::chrono::milliseconds howLong,
                                                  const Listener &listener) {
    const QDeadlineTimer limit(howLong);
    qint64 told_s = -1;
    while (!limit.hasExpired()) {
        const qint64 left_s = (limit.remainingTime() + 999) / 1000;
        if (left_s != told_s)
            listener.waiting(std::chrono::seconds(left_s));
        told_s = left_s;
        look(int(std::min<qint64>(limit.remainingTime(), waitingPeriod_ms)));
        if (const auto fine = advance(listener); !fine) {
            close();
            return fine.error();
        }
        if (joined_) {
            close();
            return std::move(*joined_);
        }
    }
    close();
    return Error(ErrorCode::TimedOut,
                 QStringLiteral("nobody joined with the code within %1 s; it is no longer good")
                     .arg(double(howLong.count()) / 1000));
}

/// Waits until somebody says something.
void PairingServer::look(int most_ms) {
    std::vector<pollfd> all{{listening_, POLLIN, 0}};
    for (const Guest &guest : guests_)
        all.push_back({guest.stream->descriptor(), guest.stream->events(), 0});
    if (::poll(all.data(), all.size(), most_ms) < 0)
        return isReady_.assign(guests_.size(), false);
    isReady_.clear();
    for (auto one = all.begin() + 1; one != all.end(); ++one)
        isReady_.push_back(one->revents != 0);
    if (all.front().revents != 0)
        accept();
}

void PairingServer::accept() {
    sockaddr_storage from{};
    socklen_t size = sizeof from;
    const int descriptor =
        ::accept4(listening_, reinterpret_cast<sockaddr *>(&from), &size, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (descriptor < 0)
        return;
    if (guests_.size() == mostGuests) {
        guests_.pop_front();
        isReady_.erase(isReady_.begin());
    }
    auto stream = std::make_unique<PairingStream>(PairingStream::Side::Server, descriptor, secret_);
    guests_.push_back({std::move(stream), textOf(from), QDeadlineTimer(longestHandshake)});
    isReady_.push_back(true); // what it says is there already, perhaps
}

/// Hears those who are ready, until one has proven the code.
Result<void> PairingServer::advance(const Listener &listener) {
    auto ready = isReady_.begin();
    for (auto guest = guests_.begin(); guest != guests_.end();) {
        const auto state = *ready++ ? guest->stream->handshake() : PairingStream::Handshake::UnderWay;
        if (state == PairingStream::Handshake::Done) {
            joined_ = std::make_unique<Joined>(Joined{std::move(guest->stream), guest->address});
            return {};
        }
        if (state == PairingStream::Handshake::Failed && guest->stream->isWrongSecret()) {
            listener.wrong(guest->address, mostWrong - ++wrong_);
            if (wrong_ == mostWrong)
                return Error(ErrorCode::NotAuthorised,
                             QStringLiteral("the code was wrong %1 times; it is no longer good, and no keys "
                                            "were made")
                                 .arg(mostWrong));
        }
        const bool ends = state == PairingStream::Handshake::Failed || guest->deadline.hasExpired();
        guest = ends ? guests_.erase(guest) : std::next(guest);
    }
    return {};
}

QStringList ownAddresses() {
    QStringList four, six;
    for (const QHostAddress &address : QNetworkInterface::allAddresses()) {
        if (address.isLoopback() || address.isLinkLocal())
            continue;
        const bool isFour = address.protocol() == QAbstractSocket::IPv4Protocol;
        (isFour ? four : six).append(address.toString());
    }
    const QStringList all = four + six;
    return all.isEmpty() ? QStringList(QStringLiteral("127.0.0.1")) : all;
}

} // namespace hermes::ctl
