#include "common/platform/ReadableFile.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace hermes {

Outcome<int> openForReading(const std::string &path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return std::string(std::strerror(errno));
    return file;
}

int standardInput() {
    return ::dup(STDIN_FILENO);
}

} // namespace hermes
