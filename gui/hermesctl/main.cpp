#include "common/Project.h"
#include "common/client/DaemonAddress.h"
#include "gui/hermesctl/Commands.h"
#include "protocol/wire/JsonText.h"

#include <QCoreApplication>
#include <cstdio>

using namespace hermes;
using namespace hermes::ctl;

namespace {

const char *const helpText = R"(Usage: hermesctl [OPTION]... COMMAND ...

Speaks to the daemons of a robot.

  list                           the daemons that answer at their default ports
  record start NAME              all loggers begin to record as one session, or none does
  record stop                    ends it and checks that nothing is missing
  record mark TEXT               puts a text with the time into what is being recorded
  record status                  what each logger records
  record list                    the sessions that were recorded
  replay SESSION                 plays a session back through the same topics, until its end or Ctrl-C
  discover D                     the commands and topics of a daemon (--json: its OpenRPC document)
  call D METHOD [NAME=VALUE]...  calls a command and prints the result; VALUE is JSON, else a string
  get D [PATH]                   all settings, or the value at a path
  set D PATH=VALUE...            changes settings: all of them, or none when one is wrong
  watch D TOPIC                  prints the messages of a topic, one JSON object a line
  log D                          the last records of the log (--count N; --follow: new ones too)
  doc D                          the reference of a daemon in Markdown

D is the name of a daemon (at its default port), HOST:PORT, or a URL.

Loggers are the daemons with the command record.start that answer at their default ports.

  --daemons A,B  record, replay: these loggers and no others
  --host HOST    where daemons given by name run (127.0.0.1)
  --timeout S    how long to wait for a connection and for a reply (5)
  --rate HZ      watch: at most so many messages a second
  --count N      watch: end after N messages; log: the last N records (100)
  --csv          watch: CSV instead of JSON
  --speed X      replay: so many times as fast (1)
  --loop         replay: begin anew at the end
  --json         discover: the whole description as JSON
  --follow       log: go on with new records
  --help, --version

Exit status: 0 success, 2 wrong usage, 1 any other failure.

Examples:
  hermesctl call scanmatcher daemon.status
  hermesctl set velodynelogger limits.clients=20
  hermesctl record start run1
  hermesctl watch scanmatcher pose --rate 5 --csv > pose.csv
)";

struct Entry {
    const char *name;
    int leastWords;
    int mostWords;
    const char *usage;
    DaemonCommand run;
};

struct RobotEntry {
    const char *name;
    int words;
    const char *usage;
    RobotCommand run;
};

constexpr int any = 1000000;

const RobotEntry robotCommands[] = {
    {"list", 0, "list", listDaemons},
    {"record start", 1, "record start NAME", recordStart},
    {"record stop", 0, "record stop", recordStop},
    {"record mark", 1, "record mark TEXT", recordMark},
    {"record status", 0, "record status", recordStatus},
    {"record list", 0, "record list", recordList},
    {"replay", 1, "replay SESSION [--speed X] [--loop]", replay},
};

const Entry commands[] = {
    {"discover", 1, 1, "discover D", discover},
    {"call", 2, any, "call D METHOD [NAME=VALUE]...", call},
    {"get", 1, 2, "get D [PATH]", getSettings},
    {"set", 2, any, "set D PATH=VALUE...", setSettings},
    {"watch", 2, 2, "watch D TOPIC [--rate HZ] [--count N] [--csv]", watch},
    {"log", 1, 1, "log D [--count N] [--follow]", showLog},
    {"doc", 1, 1, "doc D", document},
};

int usageError(const QString &text) {
    std::fprintf(stderr, "hermesctl: %s\nhermesctl --help tells what there is\n", qPrintable(text));
    return 2;
}

int finish(const Result<void> &result) {
    if (result)
        return 0;
    const Error &error = result.error();
    std::fprintf(stderr, "hermesctl: %s (%d)\n", qPrintable(error.message), error.code);
    if (!error.data.isUndefined())
        std::fprintf(stderr, "%s\n", compactJson(error.data).constData());
    return 1;
}

int runDaemonCommand(const Entry &entry, const Arguments &arguments) {
    if (arguments.words.size() < entry.leastWords || arguments.words.size() > entry.mostWords)
        return usageError(QStringLiteral("usage: hermesctl %1").arg(QLatin1String(entry.usage)));
    const bool assigns = entry.run == call || entry.run == setSettings;
    for (const QString &word : arguments.words.mid(assigns ? entry.run == call ? 2 : 1 : any)) {
        if (word.indexOf(QLatin1Char('=')) <= 0)
            return usageError(QStringLiteral("\"%1\": expected NAME=VALUE").arg(word));
    }
    const auto address = daemonAddress(arguments.words.first(), arguments.host);
    if (!address)
        return usageError(address.error().message);
    Client client;
    const auto connection = connectOnce(client, *address, arguments.timeout);
    if (!connection)
        return connection.error().is(ErrorCode::InvalidParams) ? usageError(connection.error().message)
                                                               : finish(connection);
    return finish(entry.run(client, arguments));
}

int runRobotCommand(const RobotEntry &entry, const Arguments &arguments) {
    if (arguments.words.size() != entry.words)
        return usageError(QStringLiteral("usage: hermesctl %1").arg(QLatin1String(entry.usage)));
    const Result<void> result = entry.run(arguments);
    return !result && result.error().is(ErrorCode::InvalidParams) ? usageError(result.error().message)
                                                                  : finish(result);
}

int run(Arguments arguments) {
    if (arguments.command == QStringLiteral("record") && !arguments.words.isEmpty())
        arguments.command += QLatin1Char(' ') + arguments.words.takeFirst();
    for (const RobotEntry &entry : robotCommands) {
        if (arguments.command == QLatin1String(entry.name))
            return runRobotCommand(entry, arguments);
    }
    for (const Entry &entry : commands) {
        if (arguments.command == QLatin1String(entry.name))
            return runDaemonCommand(entry, arguments);
    }
    return usageError(QStringLiteral("unknown command \"%1\"").arg(arguments.command));
}

} // namespace

int main(int argc, char **argv) {
    QCoreApplication application(argc, argv);
    const auto arguments = Arguments::parse(QCoreApplication::arguments().mid(1));
    if (!arguments)
        return usageError(arguments.error().message);
    int status = 0;
    if (arguments->help)
        std::fputs(helpText, stdout);
    else if (arguments->version)
        std::printf("hermesctl %s\n", qPrintable(projectVersion()));
    else if (arguments->command.isEmpty())
        status = usageError(QStringLiteral("a command is missing"));
    else
        status = run(*arguments);
    checkOutput();
    return status;
}
