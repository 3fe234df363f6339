#pragma once

#include "gui/hermesctl/PairingStream.h"

#include <QStringList>
#include <chrono>
#include <csignal>

namespace hermes::ctl {

/// What both sides of `keys pair` and `keys join` have agreed on. After the handshake: the keys, as KeyBundle
/// writes them; "stored" back; "accepted". Only then the keys are put where programs find them.
constexpr quint16 usualPairingPort = 7499;
constexpr std::chrono::seconds longestTransfer{10};
const QByteArray pairingStored = "stored";
const QByteArray pairingAccepted = "accepted";

/// Ctrl-C and the like have effect when this goes, so that what is begun is ended in order.
class SignalsHeld {
public:
    SignalsHeld() {
        sigset_t held;
        sigemptyset(&held);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP})
            sigaddset(&held, signal);
        ::pthread_sigmask(SIG_BLOCK, &held, &before_);
    }
    ~SignalsHeld() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalsHeld(const SignalsHeld &) = delete;
    SignalsHeld &operator=(const SignalsHeld &) = delete;

private:
    sigset_t before_{};
};

/// HOST, HOST:PORT or [HOST]:PORT; a host with several colons is an IPv6 address.
struct PairingAddress {
    QString host;
    quint16 port = usualPairingPort;

    static Result<PairingAddress> parse(const QString &text);
    /// Without the port where it is the usual one.
    QString text() const;
};

} // namespace hermes::ctl
