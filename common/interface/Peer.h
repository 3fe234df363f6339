#pragma once

#include <QString>
#include <optional>

namespace hermes {

/// What the certificate of a client or daemon says, which an authority has signed.
struct PeerCertificate {
    QString name;
    QString role;     ///< as in Role.h, or daemonRole()
    QString serial;   ///< hexadecimal digits
    double until = 0; ///< valid up to then, seconds since the epoch

    /// Of a robot: without it no client speaks to a daemon.
    static QString daemonRole() { return QStringLiteral("daemon"); }
};

/// Who is at the other end of an interface, as far as the system or a certificate tells.
struct Peer {
    enum class Place {
        Elsewhere, ///< of a network or a line
        Computer,  ///< a program of this computer, over its network stack
        UnixSocket ///< the same, over a socket that web pages cannot reach
    };
    Place place = Place::Elsewhere;
    std::optional<unsigned> user = {}; ///< of that program, where the system knows
    std::optional<PeerCertificate> certificate = {};
};

} // namespace hermes
