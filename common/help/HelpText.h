#pragma once

#include <cstddef>
#include <string>

namespace hermes {

/// A help text whose lines are broken between words so that none is wider, where a word is not. Understands
/// entries "  NAME   DESCRIPTION" with two spaces or more between both, and descriptions on lines of their
/// own that are indented further. What stands below a line "Example:" or "Examples:" is to be copied: it
/// stays as it is.
std::string fittedHelp(const std::string &text, std::size_t width);

/// The same for the terminal that stdout is, else for 80 characters.
std::string fittedHelp(const std::string &text);

} // namespace hermes
