#pragma once

#include "common/Result.h"

#include <QByteArray>
#include <QString>
#include <array>
#include <chrono>
#include <openssl/crypto.h>

namespace hermes::ctl {

/// What both sides of `keys pair` and `keys join` have agreed on. After the handshake: the keys, as KeyBundle
/// writes them; "stored" back; "accepted". Only then the keys are put where programs find them.
constexpr quint16 usualPairingPort = 7499;
constexpr std::chrono::seconds longestTransfer{10};
const QByteArray pairingStored = "stored";
const QByteArray pairingAccepted = "accepted";

/// HOST, HOST:PORT or [HOST]:PORT; a host with several colons is an IPv6 address.
struct PairingAddress {
    QString host;
    quint16 port = usualPairingPort;

    static Result<PairingAddress> parse(const QString &text);
    /// Without the port where it is the usual one.
    QString text() const;
};

/// The key that both sides of a pairing make of its code. Each copy is wiped when it goes.
struct PairingSecret {
    std::array<unsigned char, 32> bytes{};

    PairingSecret() = default;
    PairingSecret(const PairingSecret &) = default;
    PairingSecret &operator=(const PairingSecret &) = default;
    ~PairingSecret() { OPENSSL_cleanse(bytes.data(), bytes.size()); }
};

/// What people carry from one computer to another: 10 characters, 50 bits, good for one pairing.
class PairingCode {
public:
    /// From the system's generator. Error: it gives nothing.
    static Result<PairingCode> make();
    /// As people type it: small letters, spaces and hyphens anywhere. Error: what is wrong with it.
    static Result<PairingCode> read(const QString &typed);

    /// Two groups of five, with a hyphen between.
    QString text() const;
    /// The key that both sides make of it; slowly, so that who has pretended to be the other
    /// side cannot try all codes while one is good.
    Result<PairingSecret> secret() const;

private:
    explicit PairingCode(QByteArray characters)
        : characters_(std::move(characters)) {}

    QByteArray characters_;
};

} // namespace hermes::ctl
