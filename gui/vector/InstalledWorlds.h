#pragma once

#include "common/platform/Program.h"

namespace hermes::vector {

/// Where the worlds are that came with this program; empty when that cannot be told.
inline std::filesystem::path installedWorlds() {
    const std::filesystem::path program = programFile();
    return program.empty() ? program : program.parent_path().parent_path() / "share" / "hermes" / "worlds";
}

} // namespace hermes::vector
