#include "common/platform/Program.h"
#include "gui/vector/CommandLine.h"
#include "gui/vector/Options.h"

#include <algorithm>
#include <iostream>

using namespace hermes;
using namespace hermes::vector;

namespace {

constexpr const char *elsewhere[] = {"experiment", "report"};

/// For the help alone: these are commands of hermes-experiments, which is asked before.
void addElsewhere(CLI::App &app) {
    for (const char *name : elsewhere)
        app.add_subcommand(name, "Of the package hermes-experiments: hermes-experiments --help");
}

/// Lets hermes-experiments, beside this program or in the search path, do it; comes back when there is none.
int runElsewhere(const std::vector<std::string> &arguments) {
    const std::string name = "hermes-experiments";
    becomeProgram((programFile().parent_path() / name).u8string(), arguments);
    becomeProgram(name, arguments);
    std::cerr << "hermes-vector: " << arguments[0] << " is a command of the program " << name
              << ", which is not installed; in Debian the package of that name has it\n";
    return 1;
}

} // namespace

/// hermes-vector: the vector library at the command line. See docs/hermes-vector.md.
int main(int argc, char **argv) {
    const std::vector<std::string> arguments = programArguments(argc, argv);
    if (!arguments.empty() &&
        std::find(std::begin(elsewhere), std::end(elsewhere), arguments[0]) != std::end(elsewhere))
        return runElsewhere(arguments);
    const CommandLine line{"hermes-vector",
                           HERMES_VERSION,
                           "Scans to line segments, and line segments to maps.",
                           {addSegmentCommand, addVectorizeCommand, addRegisterCommand, addSimilarityCommand,
                            addMatchCommand, addRelocalizeCommand, addObserveCommand, addMapCommand,
                            addMapMergeCommand, addEvaluateCommand, addRingCommand, addElsewhere}};
    return line.run(argc, argv);
}
