#pragma once

#include "common/interface/Peer.h"

#include <QString>
#include <QStringList>
#include <optional>

namespace hermes {

/// What a client may do; each role may do what those before it may.
enum class Role {
    Observer, ///< read, subscribe, and stop
    Operator, ///< drive, record, match
    Engineer  ///< change settings and files, run programs, end the daemon
};

QString toString(Role role);
std::optional<Role> roleFrom(const QString &name);
QStringList roleNames();

/// Who gets which role without a certificate.
struct Access {
    Role plain = Role::Operator;  ///< who stands for the daemon, over TCP; lines; the network where insecure
    Role others = Role::Observer; ///< other users of this computer
};

/// Of who is at the other end. The role that a certificate says; a daemon's: Observer. Without one: of who
/// stands for the daemon, over a Unix socket, Engineer. That is its own user, root, and where it runs as a
/// service the members of its group.
Role roleOf(const Peer &peer, const Access &access);

} // namespace hermes
