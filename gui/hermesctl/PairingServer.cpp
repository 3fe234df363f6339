#include "gui/hermesctl/PairingServer.h"

#include <QHostAddress>
#include <QNetworkInterface>
#include <algorithm>

namespace hermes::ctl {
namespace {

constexpr std::chrono::seconds longestHandshake{5};
constexpr std::size_t maxGuests = 64; // at the same time, then the oldest goes
constexpr int waitingPeriod_ms = 250;

QString textOf(const sockaddr *from) {
    const QHostAddress address(from);
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
    sockets::close(std::exchange(listening_, sockets::none));
}

Result<void> PairingServer::listen(quint16 port) {
    const sockets::Listening made = sockets::listenAt(port);
    listening_ = made.socket;
    if (listening_ != sockets::none)
        return {};
    const QString why = qt_error_string(made.error);
    return Error(ErrorCode::InputOutput,
                 made.isMade
                     ? QString("cannot wait on port %1: %2; take another one with --port").arg(port).arg(why)
                     : "no socket can be made: " + why);
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
                 QString("nobody joined with the code within %1 s; it is no longer valid")
                     .arg(double(howLong.count()) / 1000));
}

/// Waits until somebody says something.
void PairingServer::look(int most_ms) {
    std::vector<sockets::Awaited> all{{listening_}};
    for (const Guest &guest : guests_)
        all.push_back(guest.stream->awaited());
    sockets::waitFor(all, most_ms);
    auto awaited = all.begin();
    for (Guest &guest : guests_)
        guest.isReady = (++awaited)->isReady;
    if (all.front().isReady)
        accept();
}

void PairingServer::accept() {
    QString address;
    const auto socket =
        sockets::accept(listening_, [&address](const sockaddr *from) { address = textOf(from); });
    if (socket == sockets::none)
        return;
    if (guests_.size() == maxGuests)
        guests_.pop_front();
    auto stream = std::make_unique<PairingStream>(PairingStream::Side::Server, socket, secret_);
    guests_.push_back({std::move(stream), address, QDeadlineTimer(longestHandshake)});
}

/// Hears those who are ready, until one has proven the code.
Result<void> PairingServer::advance(const Listener &listener) {
    for (auto guest = guests_.begin(); guest != guests_.end();) {
        const auto state = guest->isReady ? guest->stream->handshake() : PairingStream::Handshake::UnderWay;
        if (state == PairingStream::Handshake::Done) {
            joined_ = std::make_unique<Joined>(Joined{std::move(guest->stream), guest->address});
            return {};
        }
        if (state == PairingStream::Handshake::Failed && guest->stream->isWrongSecret()) {
            listener.wrong(guest->address, maxWrong - ++wrong_);
            if (wrong_ == maxWrong)
                return Error(
                    ErrorCode::NotAuthorised,
                    QString("the code was wrong %1 times; it is no longer valid, and no keys were made")
                        .arg(maxWrong));
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
    return all.isEmpty() ? QStringList("127.0.0.1") : all;
}

} // namespace hermes::ctl
