#include "common/platform/Program.h"
#include "gui/vector/CommandLine.h"
#include "gui/vector/Options.h"

#include <iostream>

using namespace hermes;
using namespace hermes::vector;

namespace {

/// Commands of hermes-experiments, which is asked before: here they are for the help alone.
void addElsewhere(CLI::App &app) {
    app.add_subcommand(
        "experiment",
        "Repeat an experiment of the documents behind Hermes (of the package hermes-experiments)");
    app.add_subcommand("report", "Register consecutive scans of a world and tell how well that went (of the "
                                 "package hermes-experiments)");
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
    if (!arguments.empty() && (arguments[0] == "experiment" || arguments[0] == "report"))
        return runElsewhere(arguments);
    const CommandLine line{"hermes-vector",
                           HERMES_VERSION,
                           "Scans to line segments, and line segments to maps.",
                           {addSegmentCommand, addVectorizeCommand, addRegisterCommand, addSimilarityCommand,
                            addMatchCommand, addRelocalizeCommand, addObserveCommand, addMapCommand,
                            addMapMergeCommand, addEvaluateCommand, addInfoCommand, addRingCommand,
                            addElsewhere}};
    return line.run(argc, argv);
}
