#include "common/platform/PrivateFiles.h"

#include <io.h>

namespace hermes {

PrivateFiles::PrivateFiles() = default;

PrivateFiles::~PrivateFiles() = default;

bool permissionsTellReaders() {
    return false;
}

bool syncToDisk(int descriptor) {
    return ::_commit(descriptor) == 0;
}

} // namespace hermes
