#pragma once

#include <CLI/CLI.hpp>

#include <vector>

namespace hermes::vector {

/// A program of several commands, of which its command line names one.
struct CommandLine {
    const char *program; ///< its name
    const char *version;
    const char *about; ///< what it does, a sentence
    std::vector<void (*)(CLI::App &)> commands;

    /// Does what the command line says; gives the exit status: 0, 1 for a failure, 2 for wrong usage.
    int run(int argc, char **argv) const;
};

} // namespace hermes::vector
