#include "common/interface/TlsServerInterface.h"

#include "common/Log.h"
#include "common/Role.h"
#include "common/Time.h"
#include "common/interface/TlsInterface.h"
#include "common/tls/KeyFolder.h"

#include <QDateTime>
#include <QFileInfo>
#include <QSslSocket>
#include <algorithm>
#include <sys/socket.h>

namespace hermes {
namespace {

const QString serverSource = QStringLiteral("server");
constexpr std::chrono::seconds longestHandshake{5};
constexpr std::size_t mostHandshakes = 16; // at the same time, then the oldest goes
constexpr int handshakesAtOnce = 1;        // to begin a handshake takes a millisecond
constexpr std::chrono::milliseconds revokedPeriod{300};

} // namespace

/// Yields sockets that are not encrypted as yet.
class TlsServerInterface::Server : public QTcpServer {
protected:
    void incomingConnection(qintptr descriptor) override {
        auto *socket = new QSslSocket(this);
        socket->setSocketDescriptor(descriptor);
        addPendingConnection(socket);
    }
};

TlsServerInterface::TlsServerInterface(const InterfaceUrl &address, QObject *parent)
    : Listener(parent)
    , url_(address)
    , folder_(address.option(QStringLiteral("keys"), KeyFolder::usual()))
    , server_(std::make_unique<Server>()) {
    // As TcpServerInterface: peers who come faster than they are taken must not keep the event loop here.
    server_->setMaxPendingConnections(handshakesAtOnce);
    connect(server_.get(), &QTcpServer::newConnection, this, &TlsServerInterface::takePeers,
            Qt::QueuedConnection);
    revokedTimer_.setInterval(revokedPeriod);
    connect(&revokedTimer_, &QTimer::timeout, this, [this] {
        lookAtRevoked();
        closeBad();
    });
}

TlsServerInterface::~TlsServerInterface() = default;

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
    if (!server_->listen(host, url_.port))
        return cannot(server_->errorString());
    ::listen(int(server_->socketDescriptor()), SOMAXCONN); // Qt lets only 50 wait
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
    server_->close();
    revokedTimer_.stop();
    for (QSslSocket *socket : std::exchange(handshakes_, {}))
        socket->deleteLater();
}

QString TlsServerInterface::address() const {
    InterfaceUrl actual = url_;
    if (server_->isListening())
        actual.port = server_->serverPort();
    return actual.toString();
}

void TlsServerInterface::takePeers() {
    while (auto *socket = qobject_cast<QSslSocket *>(server_->nextPendingConnection()))
        begin(socket);
}

void TlsServerInterface::begin(QSslSocket *socket) {
    if (socket->state() != QAbstractSocket::ConnectedState || isScarce(socket->socketDescriptor()))
        return delete socket;
    socket->setParent(this);
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
    ++refused_;
    if (const double now = monotonicNow(); now - refusedTold_ > 1) { // many may come
        refusedTold_ = now;
        logWarning(serverSource, QStringLiteral("%1: a client at %2 is refused: %3; %4 in all")
                                     .arg(address(), socket->peerAddress().toString(), why)
                                     .arg(refused_));
    }
    socket->disconnect(this);
    socket->abort();
    socket->deleteLater();
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
