#include "common/interface/TlsServerInterface.h"

#include "common/Log.h"
#include "common/Role.h"
#include "common/Time.h"
#include "common/interface/TlsInterface.h"
#include "common/tls/KeyFolder.h"

#include <QDateTime>
#include <QFileInfo>
#include <QHash>
#include <QSslSocket>
#include <algorithm>

namespace hermes {
namespace {

const QString serverSource = QStringLiteral("server");
constexpr std::chrono::seconds longestHandshake{5};
constexpr int silent_s = 3;                // the system takes up to 7 s for 5
constexpr std::size_t maxHandshakes = 256; // at the same time, then one of whoever has most of them goes
constexpr std::chrono::milliseconds revokedPeriod{300};

} // namespace

TlsServerInterface::TlsServerInterface(const InterfaceUrl &address, QObject *parent)
    : TcpListener(address, 1, silent_s, parent)
    , folder_(address.option("keys", KeyFolder::usual())) {
    revokedTimer_.setInterval(revokedPeriod);
    connect(&revokedTimer_, &QTimer::timeout, this, [this] {
        lookAtRevoked();
        closeBad();
    });
}

Result<void> TlsServerInterface::listen() {
    const auto cannot = [this](const QString &why) {
        return Error(ErrorCode::InputOutput, QString("cannot listen on %1: %2").arg(url_.toString(), why));
    };
    const auto keys = KeyFolder::load(folder_);
    if (!keys)
        return cannot(keys.error().message);
    if (const PeerCertificate own = toPeer(keys->localCertificate());
        own.role != PeerCertificate::daemonRole())
        return cannot(
            QString("%1/%2: is of \"%3\" with the role %4, and no client speaks to it; hermesctl keys "
                    "issue NAME --role daemon makes keys for a robot")
                .arg(folder_, KeyFolder::ownFile(), own.name, own.role));
    keys_ = *keys;
    lookAtRevoked();
    if (!revokedProblem_.isEmpty())
        return cannot(revokedProblem_);
    const auto listening = TcpListener::listen();
    if (!listening)
        return listening;
    revokedTimer_.start();
    constexpr double soon_s = 30.0 * 24 * 3600;
    if (const double left_s = toPeer(keys_.localCertificate()).until - stampNow(); left_s < soon_s)
        logWarning(serverSource,
                   QString("%1: its certificate expires in %2 days; hermesctl keys issue makes a "
                           "new one")
                       .arg(address())
                       .arg(int(left_s / 24 / 3600)));
    return {};
}

void TlsServerInterface::close() {
    TcpListener::close();
    revokedTimer_.stop();
    for (QSslSocket *socket : std::exchange(handshakes_, {}))
        socket->deleteLater();
}

void TlsServerInterface::noteGone(const QHostAddress &from) {
    countRefused(from, "it had gone before its handshake");
}

void TlsServerInterface::take(qintptr descriptor) {
    auto *socket = new QSslSocket(this);
    socket->setSocketDescriptor(descriptor);
    socket->setSslConfiguration(keys_);
    connect(socket, &QSslSocket::encrypted, this, [this, socket] { finish(socket); });
    connect(socket, &QAbstractSocket::errorOccurred, this,
            [this, socket] { refuse(socket, socket->errorString()); });
    QTimer::singleShot(longestHandshake, socket, [this, socket] {
        if (std::find(handshakes_.begin(), handshakes_.end(), socket) != handshakes_.end())
            refuse(socket, QString("no handshake of TLS within %1 s").arg(longestHandshake.count()));
    });
    handshakes_.push_back(socket);
    if (handshakes_.size() > maxHandshakes)
        refuse(oldestOfTheMost(), QString("%1 others came during its handshake").arg(maxHandshakes));
    socket->startServerEncryption();
}

QSslSocket *TlsServerInterface::oldestOfTheMost() const {
    QHash<QHostAddress, int> counts;
    for (const QSslSocket *socket : handshakes_)
        ++counts[socket->peerAddress()];
    const int most = *std::max_element(counts.begin(), counts.end());
    return *std::find_if(handshakes_.begin(), handshakes_.end(), [&](const QSslSocket *socket) {
        return counts.value(socket->peerAddress()) == most;
    });
}

void TlsServerInterface::finish(QSslSocket *socket) {
    const PeerCertificate theirs = toPeer(socket->peerCertificate());
    const auto what =
        QString("the certificate of \"%1\" (serial number %2) ").arg(theirs.name, theirs.serial);
    if (!revokedProblem_.isEmpty())
        return refuse(socket, revokedProblem_);
    if (revoked_.contains(theirs.serial.toLatin1()))
        return refuse(socket, what + "is revoked");
    if (!roleFrom(theirs.role) && theirs.role != PeerCertificate::daemonRole())
        return refuse(socket, what + QString("has the role \"%1\", expected one of %2, daemon")
                                         .arg(theirs.role, roleNames().join(", ")));
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
    logWarning(serverSource, QString("%1: a client at %2 is refused: %3; %4 in all")
                                 .arg(address(), from.toString(), why)
                                 .arg(refused_));
}

void TlsServerInterface::lookAtRevoked() {
    const QFileInfo file(folder_ + QLatin1Char('/') + KeyFolder::revokedFile());
    const QString state = QString("%1 %2 %3 %4")
                              .arg(file.exists() || file.isSymLink())
                              .arg(file.size())
                              .arg(file.metadataChangeTime().toMSecsSinceEpoch())
                              .arg(QFileInfo(folder_).isReadable());
    if (state == revokedState_)
        return;
    revokedState_ = state;
    auto revoked = KeyFolder::revoked(folder_);
    if (revoked && revoked->isEmpty() && !revoked_.isEmpty())
        revoked =
            Error(ErrorCode::InputOutput, file.filePath() + ": is empty or missing now, and was not before");
    revokedProblem_ = revoked ? QString() : revoked.error().message;
    if (!revoked)
        return logError(serverSource,
                        QString("%1: new clients are refused: %2").arg(address(), revokedProblem_));
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
        const QString why = isRevoked ? "its certificate is revoked" : "its certificate has expired";
        logWarning(serverSource, QString("closing client %1: %2").arg(peer->name(), why));
        peer->close(why);
    }
}

} // namespace hermes
