#include "common/platform/Console.h"
#include "common/platform/Pipes.h"
#include "common/platform/Program.h"
#include "common/platform/TemporaryNames.h"
#include "common/progress/Progress.h"
#include "gui/vector/Failure.h"
#include "gui/vector/Options.h"

#include <algorithm>
#include <iostream>

using namespace hermes;
using namespace hermes::vector;

namespace {

constexpr int failed = 1;
constexpr int wrongUsage = 2;

} // namespace

/// hermes-vector: the vector library at the command line. See docs/hermes-vector.md.
int main(int argc, char **argv) {
    prepareConsole();
    CLI::App app("Scans to line segments, and line segments to maps.");
    app.name("hermes-vector");
    app.allow_windows_style_options(false); // /a/b.csv is a file there, too
    app.set_version_flag("--version", "hermes-vector " HERMES_VERSION);
    app.require_subcommand(0, 1); // none is told below: CLI11 would not name a wrong one
    app.footer("hermes-vector COMMAND --help says more and shows an example.");
    addSegmentCommand(app);
    addVectorizeCommand(app);
    addRegisterCommand(app);
    addSimilarityCommand(app);
    addMatchCommand(app);
    addRelocalizeCommand(app);
    addObserveCommand(app);
    addMapCommand(app);
    addMapMergeCommand(app);
    addEvaluateCommand(app);
    addRingCommand(app);
    addExperimentCommand(app);
    addReportCommand(app);
    for (CLI::App *command : app.get_subcommands({}))
        command->add_flag_callback(
            "--json", Progress::useJson,
            "Tell the progress of long work as JSON, one object a line, on standard error, terminal or not");
    removeTemporariesOnSignals();
    outliveClosedPipes();
    try {
        std::vector<std::string> arguments = programArguments(argc, argv);
        std::reverse(arguments.begin(), arguments.end()); // as CLI11 wants them
        app.parse(std::move(arguments));
        if (app.get_subcommands().empty())
            throw CLI::RequiredError("A subcommand");
    } catch (const CLI::ParseError &e) {
        if (e.get_exit_code() == int(CLI::ExitCodes::Success))
            return app.exit(e); // prints the help or the version
        const auto commands = app.get_subcommands();
        std::cerr << "hermes-vector: " << e.what() << "\nSee hermes-vector "
                  << (commands.empty() ? "" : commands.front()->get_name() + ' ') << "--help.\n";
        return wrongUsage;
    } catch (const Failure &e) {
        std::cerr << "hermes-vector: " << e.what() << '\n';
        return failed;
    } catch (const std::exception &e) {
        std::cerr << "hermes-vector: unexpected failure: " << e.what() << '\n';
        return failed;
    }
    return 0;
}
