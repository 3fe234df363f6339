#pragma once

#include <optional>
#include <string>

namespace hermes::experiments {

/// What gnuplot writes to its standard output for a script. Nothing when gnuplot is not installed; throws
/// Failure with its message when it refuses the script.
std::optional<std::string> runGnuplot(const std::string &script);

} // namespace hermes::experiments
