#include "gui/vector/CommandLine.h"

#include "common/help/HelpText.h"
#include "common/platform/Console.h"
#include "common/platform/Pipes.h"
#include "common/platform/Program.h"
#include "common/platform/TemporaryNames.h"
#include "common/progress/Progress.h"
#include "gui/vector/Failure.h"

#include <algorithm>
#include <iostream>

namespace hermes::vector {

namespace {

constexpr int failed = 1;
constexpr int wrongUsage = 2;

/// The first thing of a command line that nobody knows; an option, if there is one.
std::string unknownIn(const CLI::App &app) {
    const std::vector<std::string> all = app.remaining(true);
    const auto option = std::find_if(all.begin(), all.end(), [](const auto &one) { return one[0] == '-'; });
    if (option != all.end())
        return "unknown option " + *option;
    return (app.get_subcommands().empty() ? "unknown command " : "unexpected argument ") + all.front();
}

/// What is wrong with a command line, where CLI11 tells it in its own terms.
std::string textOf(const CLI::ParseError &error, const CLI::App &app) {
    const std::string text = error.what(), name = text.substr(0, text.find(':'));
    const std::string most = ": At Most 1 required but received ", required = ": 1 required ",
                      missing = " missing";
    if (dynamic_cast<const CLI::ExtrasError *>(&error) != nullptr)
        return unknownIn(app);
    if (text.find(required) != std::string::npos && text.size() > missing.size())
        return name + ": a value is missing, expected " +
               text.substr(name.size() + required.size(),
                           text.size() - name.size() - required.size() - missing.size());
    if (text.find(most) == std::string::npos)
        return text;
    std::string names;
    const auto commands = app.get_subcommands();
    for (const std::string &one : commands.front()->get_option(name)->get_lnames())
        names += (names.empty() ? "--" : " or --") + one;
    return (names.empty() ? name : names) + ": given " + text.substr(name.size() + most.size()) +
           " times, expected once";
}

} // namespace

int CommandLine::run(int argc, char **argv) const {
    prepareConsole();
    const std::string name = program;
    CLI::App app(about);
    app.name(name);
    app.allow_windows_style_options(false); // /a/b.csv is a file there, too
    app.set_version_flag("--version", name + ' ' + version);
    app.require_subcommand(0, 1); // none is told below: CLI11 would not name a wrong one
    app.footer(name + " COMMAND --help says more and shows an example.");
    for (const auto &add : commands)
        add(app);
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
    } catch (const CLI::CallForHelp &) {
        std::cout << fittedHelp(app.help());
    } catch (const CLI::ParseError &e) {
        if (e.get_exit_code() == int(CLI::ExitCodes::Success))
            return app.exit(e); // prints the help or the version
        const auto chosen = app.get_subcommands();
        std::cerr << name << ": " << textOf(e, app) << "\nSee " << name << ' '
                  << (chosen.empty() ? "" : chosen.front()->get_name() + ' ') << "--help.\n";
        return wrongUsage;
    } catch (const Failure &e) {
        std::cerr << name << ": " << printable(e.what()) << '\n';
        return failed;
    } catch (const std::exception &e) {
        std::cerr << name << ": unexpected failure: " << e.what() << '\n';
        return failed;
    }
    return 0;
}

} // namespace hermes::vector
