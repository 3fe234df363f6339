#pragma once

#include <filesystem>

namespace hermes::vector {

/// Where the worlds are that came with this program; empty when that cannot be told.
inline std::filesystem::path installedWorlds() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::filesystem::path()
                 : program.parent_path().parent_path() / "share" / "hermes" / "worlds";
}

} // namespace hermes::vector
