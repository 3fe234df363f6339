#include "common/interface/TlsServerInterface.h"

#include "common/Log.h"
#include "common/Role.h"
#include "common/Time.h"
#include "common/interface/TlsInterface.h"
#include "common/platform/Sockets.h"
#include "common/tls/KeyFolder.h"

#include <QDateTime>
#include <QFileInfo>
#include <QSslSocket>
#include <algorithm>
#include <poll.h>
#include <sys/socket.h>

namespace hermes {
namespace {

const QString serverSource = QStringLiteral("server");
constexpr std::chrono::seconds longestHandshake{5};
constexpr std::size_t mostHandshakes = 16; // at the same time, then the oldest goes
constexpr int goneAtOnce = 30;             // a millisecond, as one handshake takes to begin
constexpr std::chrono::milliseconds revokedPeriod{300};

/// Whether the peer has closed the connection, also when it said something before.
bool hasGone(sockets::Socket descriptor) {
    pollfd connection{int(descriptor), POLLRDHUP, 0};
    return ::poll(&connection, 1, 0) > 0;
}

} // namespace

TlsServerInterface::TlsServerInterface(const InterfaceUrl &address, QObject *parent)
    : Listener(parent)
    , url_(address)
    , folder_(address.option(QStringLiteral("keys"), KeyFolder::usual())) {
    revokedTimer_.setInterval(revokedPeriod);
    connect(&revokedTimer_, &QTimer::timeout, this, [this] {
        lookAtRevoked();
        closeBad();
    });
}

Result<void> TlsServerInterface::listen() {
    const auto cannot = [this](const QString &why) {
        return Error(ErrorCode::InputOutput,
                     QStringLiteral("cannot listen on %1: %2").arg(url_.toString(), why));
    };
    const auto keys = KeyFolder::load(folder_);
    if (!keys)
        return cannot(keys.error().message);
    if (const PeerCertificate own = toPeer(keys->localCertificate());
        own.role != PeerCertificate::daemonRole())
        return cannot(
            QStringLiteral("%1/%2: is of \"%3\" with the role %4, and no client speaks to it; hermesctl keys "
                           "issue NAME --role daemon makes keys for a robot")
                .arg(folder_, KeyFolder::ownFile(), own.name, own.role));
    keys_ = *keys;
    lookAtRevoked();
    if (!revokedProblem_.isEmpty())
        return cannot(revokedProblem_);
    const QHostAddress host(url_.host == QStringLiteral("localhost") ? QStringLiteral("127.0.0.1")
                                                                     : url_.host);
    if (host.isNull())
        return cannot(QStringLiteral("\"%1\" is not an IP address").arg(url_.host));
    if (!server_.listen(host, url_.port))
        return cannot(server_.errorString());
    server_.pauseAccepting();                             // Qt would take all who wait
    ::listen(int(server_.socketDescriptor()), SOMAXCONN); // Qt lets only 50 wait
    arrivals_ = std::make_unique<QSocketNotifier>(server_.socketDescriptor(), QSocketNotifier::Read);
    connect(arrivals_.get(), &QSocketNotifier::activated, this, &TlsServerInterface::takePeers);
    revokedTimer_.start();
    constexpr double soon_s = 30.0 * 24 * 3600;
    if (const double left_s = toPeer(keys_.localCertificate()).until - stampNow(); left_s < soon_s)
        logWarning(serverSource,
                   QStringLiteral("%1: its certificate expires in %2 days; hermesctl keys issue makes a "
                                  "new one")
                       .arg(address())
                       .arg(int(left_s / 24 / 3600)));
    return {};
}

void TlsServerInterface::close() {
    arrivals_.reset();
    server_.close();
    revokedTimer_.stop();
    for (QSslSocket *socket : std::exchange(handshakes_, {}))
        socket->deleteLater();
}

QString TlsServerInterface::address() const {
    InterfaceUrl actual = url_;
    if (server_.isListening())
        actual.port = server_.serverPort();
    return actual.toString();
}

// One who has come to stay at a time. Those who have gone cost hardly anything: a storm of strangers leaves
// thousands in the queue, and a true client behind them does not wait for their handshakes.
void TlsServerInterface::takePeers() {
    for (int i = 0; i < goneAtOnce; ++i) {
        QHostAddress from;
        const auto descriptor = sockets::accept(
            server_.socketDescriptor(), [&from](const sockaddr *address) { from.setAddress(address); });
        if (descriptor == sockets::none)
            return;
        const bool gone = hasGone(descriptor);
        if (!gone && !isScarce(descriptor))
            return begin(descriptor);
        sockets::close(descriptor);
        if (gone)
            countRefused(from, QStringLiteral("it had gone before its handshake"));
    }
}

void TlsServerInterface::begin(qintptr descriptor) {
    auto *socket = new QSslSocket(this);
    socket->setSocketDescriptor(descriptor);
    socket->setSslConfiguration(keys_);
    connect(socket, &QSslSocket::encrypted, this, [this, socket] { finish(socket); });
    connect(socket, &QAbstractSocket::errorOccurred, this,
            [this, socket] { refuse(socket, socket->errorString()); });
    QTimer::singleShot(longestHandshake, socket, [this, socket] {
        if (std::find(handshakes_.begin(), handshakes_.end(), socket) != handshakes_.end())
            refuse(socket, QStringLiteral("no handshake of TLS within %1 s").arg(longestHandshake.count()));
    });
    handshakes_.push_back(socket);
    if (handshakes_.size() > mostHandshakes)
        refuse(handshakes_.front(),
               QStringLiteral("%1 others came during its handshake").arg(mostHandshakes));
    socket->startServerEncryption();
}

void TlsServerInterface::finish(QSslSocket *socket) {
    const PeerCertificate theirs = toPeer(socket->peerCertificate());
    const auto what =
        QStringLiteral("the certificate of \"%1\" (serial number %2) ").arg(theirs.name, theirs.serial);
    if (!revokedProblem_.isEmpty())
        return refuse(socket, revokedProblem_);
    if (revoked_.contains(theirs.serial.toLatin1()))
        return refuse(socket, what + QStringLiteral("is revoked"));
    if (!roleFrom(theirs.role) && theirs.role != PeerCertificate::daemonRole())
        return refuse(socket, what + QStringLiteral("has the role \"%1\", expected one of %2, daemon")
                                         .arg(theirs.role, roleNames().join(QStringLiteral(", "))));
    handshakes_.remove(socket);
    socket->disconnect(this);
    auto *peer = new TlsInterface(socket, this);
    peers_.push_back(peer);
    connect(peer, &QObject::destroyed, this, [this, peer] { peers_.remove(peer); });
    peer->open();
    Q_EMIT accepted(peer);
}

void TlsServerInterface::refuse(QSslSocket *socket, const QString &why) {
    handshakes_.remove(socket);
    countRefused(socket->peerAddress(), why);
    socket->disconnect(this);
    socket->abort();
    socket->deleteLater();
}

void TlsServerInterface::countRefused(const QHostAddress &from, const QString &why) {
    ++refused_;
    const double now = monotonicNow();
    if (now - refusedTold_ < 1) // many may come
        return;
    refusedTold_ = now;
    logWarning(serverSource, QStringLiteral("%1: a client at %2 is refused: %3; %4 in all")
                                 .arg(address(), from.toString(), why)
                                 .arg(refused_));
}

void TlsServerInterface::lookAtRevoked() {
    const QFileInfo file(folder_ + QLatin1Char('/') + KeyFolder::revokedFile());
    const QString state = QStringLiteral("%1 %2 %3 %4")
                              .arg(file.exists() || file.isSymLink())
                              .arg(file.size())
                              .arg(file.metadataChangeTime().toMSecsSinceEpoch())
                              .arg(QFileInfo(folder_).isReadable());
    if (state == revokedState_)
        return;
    revokedState_ = state;
    auto revoked = KeyFolder::revoked(folder_);
    if (revoked && revoked->isEmpty() && !revoked_.isEmpty())
        revoked = Error(ErrorCode::InputOutput,
                        file.filePath() + QStringLiteral(": is empty or missing now, and was not before"));
    revokedProblem_ = revoked ? QString() : revoked.error().message;
    if (!revoked)
        return logError(serverSource,
                        QStringLiteral("%1: new clients are refused: %2").arg(address(), revokedProblem_));
    revoked_ = *revoked;
}

void TlsServerInterface::closeBad() {
    const auto all = peers_;
    for (TlsInterface *peer : all) {
        const auto theirs = peer->peer().certificate;
        if (!peer->isOpen() || !theirs)
            continue;
        const bool isRevoked = revoked_.contains(theirs->serial.toLatin1());
        if (!isRevoked && stampNow() < theirs->until)
            continue;
        const QString why = isRevoked ? QStringLiteral("its certificate is revoked")
                                      : QStringLiteral("its certificate has expired");
        logWarning(serverSource, QStringLiteral("closing client %1: %2").arg(peer->name(), why));
        peer->close(why);
    }
}

} // namespace hermes
