#include "common/ServiceAccount.h"

// No daemon runs on Windows (docs/windows.md), so nobody stands for one.
namespace hermes {

bool ServiceAccount::hasMember(unsigned, unsigned) {
    return false;
}

bool ServiceAccount::standsForThisProgram(unsigned) {
    return false;
}

QString ServiceAccount::nameOf(unsigned user) {
    return QString::number(user);
}

} // namespace hermes
