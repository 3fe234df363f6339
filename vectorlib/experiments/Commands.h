#pragma once

#include <CLI/CLI.hpp>

namespace hermes::experiments {

// One function a command of hermes-experiments; each in a file of its own.
void addExperimentCommand(CLI::App &app);
void addReportCommand(CLI::App &app);

} // namespace hermes::experiments
