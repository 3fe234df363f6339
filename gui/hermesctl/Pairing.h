#pragma once

#include "gui/hermesctl/PairingStream.h"

#include <QStringList>
#include <chrono>

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

} // namespace hermes::ctl
