#pragma once

#include <QString>
#include <sys/types.h>

namespace hermes {

/// The account of a service, as of packages: of a system user (not root, not a person). Members of its group
/// stand for it.
namespace ServiceAccount {

/// That `account` is one and `user` is a member of its group. What the system does not know is none.
bool hasMember(uid_t account, uid_t user);
/// "anna"; the number where the system knows no name.
QString nameOf(uid_t user);

} // namespace ServiceAccount

} // namespace hermes
