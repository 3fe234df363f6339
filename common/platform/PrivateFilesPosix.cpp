#include "common/platform/PrivateFiles.h"

#include <sys/stat.h>
#include <unistd.h>

namespace hermes {

PrivateFiles::PrivateFiles()
    : before_(::umask(077)) {}

PrivateFiles::~PrivateFiles() {
    ::umask(mode_t(before_));
}

bool permissionsTellReaders() {
    return true;
}

bool syncToDisk(int descriptor) {
    return ::fsync(descriptor) == 0;
}

} // namespace hermes
