#pragma once

#include "common/Outcome.h"

namespace hermes {

/// A descriptor of the C library for reading the bytes of a file, path in UTF-8.
Outcome<int> openForReading(const std::string &path);

/// Another descriptor of standard input.
int standardInput();

} // namespace hermes
