#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hermes {

/// What follows the program's name at the command line, in UTF-8 whatever the system's code page is.
std::vector<std::string> programArguments(int argc, char **argv);

/// Where this program lies; empty when that cannot be told.
std::filesystem::path programFile();

/// Puts another program in the place of this one, with the same standard streams: of the search path, or that
/// file where the name has a folder. Comes back only when there is none.
void becomeProgram(const std::string &name, const std::vector<std::string> &arguments);

} // namespace hermes
