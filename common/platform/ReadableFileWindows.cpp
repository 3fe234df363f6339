#include "common/platform/ReadableFile.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <io.h>

namespace hermes {

Outcome<int> openForReading(const std::string &path) {
    const int file = ::_wopen(std::filesystem::u8path(path).c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT);
    if (file < 0)
        return std::string(std::strerror(errno));
    return file;
}

int standardInput() {
    return ::_dup(0);
}

} // namespace hermes
