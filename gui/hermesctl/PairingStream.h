#pragma once

#include "common/Result.h"
#include "common/platform/Sockets.h"
#include "gui/hermesctl/Pairing.h"

#include <QByteArray>
#include <QDeadlineTimer>
#include <memory>
#include <openssl/ssl.h>

namespace hermes::ctl {

/// One end of a connection whose two sides prove to each other that they know the same secret: TLS 1.2 with
/// ECDHE-PSK (RFC 5489), no certificates. Carries frames: 4 bytes of length, the most significant first, and
/// the content. Waits at most until the deadline it is given.
class PairingStream {
public:
    enum class Side { Server, Client };
    enum class Handshake { UnderWay, Done, Failed };

    /// Takes over the connected socket.
    PairingStream(Side side, sockets::Socket socket, const PairingSecret &secret);
    ~PairingStream();
    PairingStream(const PairingStream &) = delete;
    PairingStream &operator=(const PairingStream &) = delete;

    /// Goes on with what has arrived, and waits for nothing.
    Handshake handshake();
    /// What the handshake waits for.
    sockets::Awaited awaited() const;
    /// A server's handshake failed because the other side has another secret: it was not cut off before.
    bool isWrongSecret() const { return isWrongSecret_; }
    /// A client's whole handshake.
    Result<void> handshakeUntil(const QDeadlineTimer &deadline);

    Result<void> send(const QByteArray &frame, const QDeadlineTimer &deadline);
    Result<QByteArray> receive(int maxBytes, const QDeadlineTimer &deadline);

private:
    static SSL_CTX *context(Side side);
    static unsigned serverSecret(SSL *ssl, const char *identity, unsigned char *secret, unsigned most);
    static unsigned clientSecret(SSL *ssl, const char *hint, char *identity, unsigned maxIdentity,
                                 unsigned char *secret, unsigned most);
    void judgeFailure(int error);
    Result<void> waitFor(bool toWrite, const QDeadlineTimer &deadline) const;
    Result<void> waitAfter(int error, const QDeadlineTimer &deadline) const;
    Result<QByteArray> receiveBytes(int count, const QDeadlineTimer &deadline);

    const sockets::Socket socket_;
    const PairingSecret secret_;
    std::unique_ptr<SSL, decltype(&SSL_free)> ssl_;
    bool secretIsUsed_ = false;
    bool isWrongSecret_ = false;
    QString failure_; // of the handshake
};

} // namespace hermes::ctl
