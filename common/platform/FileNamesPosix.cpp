#include "common/platform/FileNames.h"

namespace hermes {

bool isSameName(const std::filesystem::path &one, const std::filesystem::path &other) {
    return one == other;
}

bool isDeviceName(const std::filesystem::path &) {
    return false;
}

} // namespace hermes
