#pragma once

#include <cstddef>
#include <string>

namespace hermes {

/// Remembers files, and folders before what lies in them, that a signal which ends the program is to remove.
/// Gives the place of the name, for forgetTemporary(). On Windows nothing is remembered: files that are not
/// complete end with their process, whatever ends it, folders stay.
std::size_t rememberTemporary(const std::string &name);
void forgetTemporary(std::size_t place);

/// Lets signals do so.
void removeTemporariesOnSignals();

} // namespace hermes
