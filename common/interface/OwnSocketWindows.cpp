#include "common/interface/OwnSocket.h"

namespace hermes {

int connectToOwnSocket(const InterfaceUrl &) {
    return -1;
}

} // namespace hermes
