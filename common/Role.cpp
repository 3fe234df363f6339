#include "common/Role.h"

#include "common/ServiceAccount.h"

namespace hermes {

QString toString(Role role) {
    return roleNames().at(int(role));
}

QStringList roleNames() {
    return {QStringLiteral("observer"), QStringLiteral("operator"), QStringLiteral("engineer")};
}

std::optional<Role> roleFrom(const QString &name) {
    const int index = roleNames().indexOf(name);
    return index < 0 ? std::nullopt : std::optional(Role(index));
}

Role roleOf(const Peer &peer, const Access &access) {
    if (peer.certificate)
        return roleFrom(peer.certificate->role).value_or(Role::Observer);
    if (peer.place == Peer::Place::Elsewhere)
        return access.plain;
    if (!peer.user || !ServiceAccount::standsForThisProgram(*peer.user))
        return access.others;
    return peer.place == Peer::Place::UnixSocket ? Role::Engineer : access.plain;
}

} // namespace hermes
