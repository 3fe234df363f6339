#include "common/platform/TemporaryNames.h"

namespace hermes {

std::size_t rememberTemporary(const std::string &) {
    return 0;
}

void forgetTemporary(std::size_t) {}

void removeTemporariesOnSignals() {}

} // namespace hermes
