#pragma once

#include "common/platform/Program.h"

#include <string>

namespace hermes::vector {

/// Where the worlds are that came with this program; empty when that cannot be told.
inline std::filesystem::path installedWorlds() {
    const std::filesystem::path program = programFile();
    return program.empty() ? program : program.parent_path().parent_path() / "share" / "hermes" / "worlds";
}

/// The file of a world: the one at this path, else the installed one of this name. Throws Failure, which
/// tells the installed names, when there is neither.
std::string worldFile(const std::string &nameOrPath);

} // namespace hermes::vector
