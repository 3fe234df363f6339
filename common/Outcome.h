#pragma once

#include "vectorlib/error/Result.h"

#include <string>

namespace hermes {

/// What Result is below Qt: a value, or a sentence that says what failed, where, what was found and expected.
template <typename T>
using Outcome = vectorlib::Result<T, std::string>;

} // namespace hermes
