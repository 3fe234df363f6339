#pragma once

#include <QString>

namespace hermes {

/// The account of a service, as of packages: of a system user (not root, not a person). Members of its group
/// stand for it.
namespace ServiceAccount {

/// That `account` is one and `user` is a member of its group. What the system does not know is none.
bool hasMember(unsigned account, unsigned user);
/// That `user` stands for the one that runs this program: is it, root, or a member where that is such an
/// account.
bool standsForThisProgram(unsigned user);
/// "anna"; the number where the system knows no name.
QString nameOf(unsigned user);

} // namespace ServiceAccount

} // namespace hermes
