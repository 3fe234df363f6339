#pragma once

#include "vectorlib/experiments/report/Report.h"

namespace hermes::experiments {

/// A world by the name of its file, or, where there is no such file, by the name of one that is installed
/// with the program (share/hermes/worlds). Throws Failure.
ReportWorld findWorld(const std::string &name);

/// The settings of the thesis appendices for a world of this name; the default ones for others.
ReportSettings settingsFor(const std::string &name);

} // namespace hermes::experiments
