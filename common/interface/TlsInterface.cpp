#include "common/interface/TlsInterface.h"

#include "common/tls/KeyFolder.h"

#include <algorithm>

namespace hermes {

namespace {

/// Robots change their addresses.
bool isAccepted(const QSslError &error) {
    return error.error() == QSslError::HostNameMismatch;
}

/// What is wrong besides.
QString textOf(const QList<QSslError> &errors) {
    QStringList texts;
    for (const QSslError &error : errors)
        if (!isAccepted(error))
            texts.append(error.errorString());
    texts.removeDuplicates();
    return texts.join("; ");
}

} // namespace

TlsInterface::TlsInterface(const InterfaceUrl &address, QObject *parent)
    : TlsInterface(address, new QSslSocket, parent) {
    connect(socket_, &QSslSocket::encrypted, this, &TlsInterface::onEncrypted, Qt::QueuedConnection);
    connect(socket_, QOverload<const QList<QSslError> &>::of(&QSslSocket::sslErrors), this,
            [this](const QList<QSslError> &errors) {
                if (std::all_of(errors.begin(), errors.end(), isAccepted))
                    return socket_->ignoreSslErrors();
                refused_ = "the certificate there is not accepted: " + textOf(errors);
            });
}

TlsInterface::TlsInterface(const InterfaceUrl &address, QSslSocket *socket, QObject *parent)
    : TcpInterface(address, socket, parent)
    , url_(address)
    , socket_(socket) {
    connect(socket_, &QSslSocket::encryptedBytesWritten, this, &TlsInterface::noteWritten);
}

TlsInterface::TlsInterface(QSslSocket *encrypted, QObject *theHost)
    : TcpInterface(encrypted, theHost)
    , socket_(encrypted) {
    connect(socket_, &QSslSocket::encryptedBytesWritten, this, &TlsInterface::noteWritten);
}

QString TlsInterface::folder() const {
    return url_.option("keys", KeyFolder::usual());
}

void TlsInterface::noteRead() {
    const auto look = [this, read = ++reads_] { // behind the decryption, which the read has queued
        if (reads_ == read)
            TcpInterface::noteRead();
    };
    QMetaObject::invokeMethod(this, look, Qt::QueuedConnection);
}

QString TlsInterface::name() const {
    if (!url_.scheme.isEmpty())
        return url_.toString();
    const PeerCertificate theirs = toPeer(socket_->peerCertificate());
    return QString("tls://%1:%2 (%3, %4)")
        .arg(socket_->peerAddress().toString())
        .arg(socket_->peerPort())
        .arg(theirs.name, theirs.role);
}

Peer TlsInterface::peer() const {
    return {Peer::Place::Elsewhere, std::nullopt, toPeer(socket_->peerCertificate())};
}

void TlsInterface::doOpen() {
    if (isConnected())
        return TcpInterface::doOpen(); // a peer of a server
    const auto keys = KeyFolder::load(folder());
    if (!keys)
        return nowClosed(QString("%1: %2").arg(name(), keys.error().message), true);
    refused_.clear();
    setReceiving(true);
    socket_->setSslConfiguration(*keys);
    socket_->connectToHostEncrypted(url_.host, url_.port);
}

// Any client has a certificate of the authority, too.
void TlsInterface::onEncrypted() {
    const PeerCertificate theirs = toPeer(socket_->peerCertificate());
    const auto revoked = KeyFolder::revoked(folder());
    QString wrong;
    if (theirs.role != PeerCertificate::daemonRole())
        wrong = QString("is of \"%1\" with the role %2, not of a daemon").arg(theirs.name, theirs.role);
    else if (!revoked)
        wrong = "may be revoked: " + revoked.error().message;
    else if (revoked->contains(theirs.serial.toLatin1()))
        wrong = QString("of \"%1\" is revoked").arg(theirs.name);
    if (wrong.isEmpty())
        return begin();
    socket_->abort();
    nowClosed(QString("%1: the certificate there %2").arg(name(), wrong), true);
}

} // namespace hermes
