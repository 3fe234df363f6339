#include "gui/hermesctl/PairingStream.h"

#include <QtEndian>
#include <algorithm>
#include <cstring>
#include <openssl/err.h>
#include <openssl/sslerr.h>

namespace hermes::ctl {
namespace {

// One suite, with forward secrecy: who listens learns nothing that a code could be tried against.
const char *const suite = "ECDHE-PSK-CHACHA20-POLY1305";
const char *const identityText = "hermes pairing 1";
constexpr int lengthBytes = 4;
constexpr int maxAtOnce = 1 << 16;

QString reasonOf(unsigned long error) {
    const char *const text = ERR_reason_error_string(error);
    return text ? QString::fromLatin1(text) : "the connection was closed";
}

unsigned copySecret(const PairingSecret &secret, unsigned char *to, unsigned most) {
    if (secret.bytes.size() > most)
        return 0;
    std::memcpy(to, secret.bytes.data(), secret.bytes.size());
    return unsigned(secret.bytes.size());
}

} // namespace

SSL_CTX *PairingStream::context(Side side) {
    const auto make = [](const SSL_METHOD *method) {
        SSL_CTX *const made = SSL_CTX_new(method);
        const bool isSet = made && SSL_CTX_set_min_proto_version(made, TLS1_2_VERSION) == 1 &&
                           SSL_CTX_set_max_proto_version(made, TLS1_2_VERSION) == 1 &&
                           SSL_CTX_set_cipher_list(made, suite) == 1;
        if (!isSet) {
            SSL_CTX_free(made);
            return static_cast<SSL_CTX *>(nullptr);
        }
        SSL_CTX_set_options(made, SSL_OP_NO_TICKET | SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
        SSL_CTX_set_session_cache_mode(made, SSL_SESS_CACHE_OFF);
        SSL_CTX_set_mode(made, SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
        SSL_CTX_set_psk_server_callback(made, serverSecret);
        SSL_CTX_set_psk_client_callback(made, clientSecret);
        return made;
    };
    static SSL_CTX *const ofServer = make(TLS_server_method()), *const ofClient = make(TLS_client_method());
    return side == Side::Server ? ofServer : ofClient;
}

unsigned PairingStream::serverSecret(SSL *ssl, const char *identity, unsigned char *secret, unsigned most) {
    auto *const self = static_cast<PairingStream *>(SSL_get_app_data(ssl));
    if (!identity || std::strcmp(identity, identityText) != 0)
        return 0;
    self->secretIsUsed_ = true;
    return copySecret(self->secret_, secret, most);
}

unsigned PairingStream::clientSecret(SSL *ssl, const char *, char *identity, unsigned maxIdentity,
                                     unsigned char *secret, unsigned most) {
    auto *const self = static_cast<PairingStream *>(SSL_get_app_data(ssl));
    if (std::strlen(identityText) >= maxIdentity)
        return 0;
    std::strcpy(identity, identityText);
    self->secretIsUsed_ = true;
    return copySecret(self->secret_, secret, most);
}

PairingStream::PairingStream(Side side, sockets::Socket socket, const PairingSecret &secret)
    : socket_(socket)
    , secret_(secret)
    , ssl_(SSL_new(context(side)), &SSL_free) {
    if (!ssl_)
        return;
    SSL_set_app_data(ssl_.get(), this);
    SSL_set_fd(ssl_.get(), int(socket_)); // of Windows, too: handles fit into an int
    side == Side::Server ? SSL_set_accept_state(ssl_.get()) : SSL_set_connect_state(ssl_.get());
}

PairingStream::~PairingStream() {
    if (ssl_ && SSL_is_init_finished(ssl_.get()))
        SSL_shutdown(ssl_.get());
    ERR_clear_error();
    sockets::endAndClose(socket_); // the last words, an alert perhaps, arrive
}

PairingStream::Handshake PairingStream::handshake() {
    if (!ssl_) {
        failure_ = QString("OpenSSL here has no ") + suite;
        return Handshake::Failed;
    }
    ERR_clear_error();
    const int result = SSL_do_handshake(ssl_.get());
    if (result == 1)
        return Handshake::Done;
    const int error = SSL_get_error(ssl_.get(), result);
    if (error == SSL_ERROR_WANT_READ || error == SSL_ERROR_WANT_WRITE)
        return Handshake::UnderWay;
    judgeFailure(error);
    return Handshake::Failed;
}

// Who goes without having sent what the secret is needed for has not guessed. A client is told by an alert.
void PairingStream::judgeFailure(int error) {
    const unsigned long code = ERR_peek_error();
    const int reason = ERR_GET_REASON(code);
    failure_ = reasonOf(code);
    const bool isToldByOther =
        reason == SSL_R_SSLV3_ALERT_BAD_RECORD_MAC || reason == SSL_R_TLSV1_ALERT_DECRYPT_ERROR;
    const bool isCutOff = error != SSL_ERROR_SSL || reason == SSL_R_UNEXPECTED_EOF_WHILE_READING;
    isWrongSecret_ = secretIsUsed_ && !isCutOff && (SSL_is_server(ssl_.get()) || isToldByOther);
    ERR_clear_error();
}

sockets::Awaited PairingStream::awaited() const {
    return {socket_, ssl_ && SSL_want_write(ssl_.get())};
}

Result<void> PairingStream::waitAfter(int error, const QDeadlineTimer &deadline) const {
    if (error != SSL_ERROR_WANT_READ && error != SSL_ERROR_WANT_WRITE) {
        const Error ended(ErrorCode::Disconnected, "the other side: " + reasonOf(ERR_peek_error()));
        ERR_clear_error();
        return ended;
    }
    return waitFor(error == SSL_ERROR_WANT_WRITE, deadline);
}

Result<void> PairingStream::waitFor(bool toWrite, const QDeadlineTimer &deadline) const {
    std::vector<sockets::Awaited> one{{socket_, toWrite}};
    const bool isExpired = deadline.hasExpired() || !sockets::waitFor(one, int(deadline.remainingTime()));
    return isExpired ? Error(ErrorCode::TimedOut, "the other side says nothing") : Result<void>();
}

Result<void> PairingStream::handshakeUntil(const QDeadlineTimer &deadline) {
    Handshake state = handshake();
    while (state == Handshake::UnderWay) {
        const auto ready = waitFor(awaited().toWrite, deadline);
        if (!ready)
            return ready;
        state = handshake();
    }
    return state == Handshake::Done ? Result<void>() : Error(ErrorCode::Disconnected, failure_);
}

Result<void> PairingStream::send(const QByteArray &frame, const QDeadlineTimer &deadline) {
    QByteArray bytes(lengthBytes, '\0');
    qToBigEndian(quint32(frame.size()), bytes.data());
    bytes += frame;
    for (int sent = 0; sent < bytes.size();) {
        ERR_clear_error();
        const int result = SSL_write(ssl_.get(), bytes.constData() + sent, bytes.size() - sent);
        if (result > 0) {
            sent += result;
            if (deadline.hasExpired())
                return Error(ErrorCode::TimedOut, "the other side reads too slowly");
        } else if (const auto ready = waitAfter(SSL_get_error(ssl_.get(), result), deadline); !ready) {
            return ready;
        }
    }
    return {};
}

Result<QByteArray> PairingStream::receiveBytes(int count, const QDeadlineTimer &deadline) {
    QByteArray bytes;
    char part[maxAtOnce];
    while (bytes.size() < count) {
        ERR_clear_error();
        const int result = SSL_read(ssl_.get(), part, std::min(maxAtOnce, count - bytes.size()));
        if (result > 0) {
            bytes.append(part, result);
            if (deadline.hasExpired())
                return Error(ErrorCode::TimedOut, "the other side sends too slowly");
        } else if (const auto ready = waitAfter(SSL_get_error(ssl_.get(), result), deadline); !ready) {
            return ready.error();
        }
    }
    return bytes;
}

Result<QByteArray> PairingStream::receive(int maxBytes, const QDeadlineTimer &deadline) {
    const auto length = receiveBytes(lengthBytes, deadline);
    if (!length)
        return length.error();
    const auto count = qFromBigEndian<quint32>(length->constData());
    if (count > quint32(maxBytes))
        return Error(
            ErrorCode::OverLimit,
            QString("the other side wants to send %1 bytes, %2 at most are taken").arg(count).arg(maxBytes));
    return receiveBytes(int(count), deadline);
}

} // namespace hermes::ctl
