#include "common/interface/TcpListener.h"

#include "common/platform/Sockets.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

namespace hermes {
namespace {

constexpr int goneAtOnce = 30; // peers: a millisecond

bool hasClosedItsEnd(sockets::Socket descriptor) {
    pollfd connection{int(descriptor), POLLRDHUP, 0};
    return ::poll(&connection, 1, 0) > 0;
}

} // namespace

TcpListener::TcpListener(const InterfaceUrl &address, int atOnce, int silent_s, QObject *parent)
    : Listener(parent)
    , url_(address)
    , atOnce_(atOnce)
    , silent_s_(silent_s) {}

Result<void> TcpListener::listen() {
    const auto cannot = [this](const QString &why) {
        return Error(ErrorCode::InputOutput, QString("cannot listen on %1: %2").arg(url_.toString(), why));
    };
    const QHostAddress host(url_.host == "localhost" ? "127.0.0.1" : url_.host);
    if (host.isNull())
        return cannot(QString("\"%1\" is not an IP address").arg(url_.host));
    if (!server_.listen(host, url_.port))
        return cannot(server_.serverError() == QAbstractSocket::AddressInUseError
                          ? QString("port %1 of %2 is already in use; end the program that uses it or "
                                    "listen elsewhere (--listen URL)")
                                .arg(url_.port)
                                .arg(url_.host)
                          : server_.errorString());
    server_.pauseAccepting(); // Qt would take all who wait
    const int descriptor = int(server_.socketDescriptor());
    if (silent_s_ > 0)
        ::setsockopt(descriptor, IPPROTO_TCP, TCP_DEFER_ACCEPT, &silent_s_, sizeof silent_s_);
    ::listen(descriptor, SOMAXCONN); // Qt lets only 50 wait
    arrivals_ = std::make_unique<QSocketNotifier>(descriptor, QSocketNotifier::Read);
    connect(arrivals_.get(), &QSocketNotifier::activated, this, &TcpListener::takePeers);
    return {};
}

void TcpListener::close() {
    arrivals_.reset();
    server_.close();
}

QString TcpListener::address() const {
    InterfaceUrl actual = url_;
    if (server_.isListening())
        actual.port = server_.serverPort();
    return actual.toString();
}

void TcpListener::takePeers() {
    for (int gone = 0, taken = 0; gone < goneAtOnce && taken < atOnce_;) {
        QHostAddress from;
        const auto descriptor = sockets::accept(
            server_.socketDescriptor(), [&from](const sockaddr *address) { from.setAddress(address); });
        if (descriptor == sockets::none)
            return;
        if (hasClosedItsEnd(descriptor) && !isHeard(descriptor)) {
            ++gone;
            sockets::close(descriptor);
            noteGone(from);
        } else if (isScarce(descriptor)) {
            ++gone;
            sockets::close(descriptor);
        } else {
            ++taken;
            take(descriptor);
        }
    }
}

} // namespace hermes
