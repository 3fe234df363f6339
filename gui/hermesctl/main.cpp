#include "common/Project.h"
#include "common/client/DaemonAddress.h"
#include "common/help/HelpText.h"
#include "common/platform/Console.h"
#include "common/platform/Pipes.h"
#include "common/platform/PrivateFiles.h"
#include "common/progress/Progress.h"
#include "gui/hermesctl/Advice.h"
#include "gui/hermesctl/Completion.h"
#include "gui/hermesctl/Nearest.h"
#include "gui/hermesctl/Subcommands.h"
#include "protocol/wire/JsonText.h"

#include <QCoreApplication>
#include <optional>

using namespace hermes;
using namespace hermes::ctl;

namespace {

constexpr int usageStatus = 2;

/// What the data of an error say, for people, as "needed: engineer". Of `errors` the message tells.
QStringList linesOf(const Error &error) {
    QStringList lines;
    const QJsonObject data = error.data.toObject();
    for (auto one = data.begin(); one != data.end(); ++one)
        if (one.key() != "errors")
            lines.append(
                one.key() + ": " +
                (one->isString() ? printable(one->toString()) : QString::fromUtf8(compactJson(*one))));
    return lines;
}

/// Tells of a failure on stderr, for people or, with --json, for programs.
void tell(const Error &error, const QStringList &advice, bool json) {
    if (json) {
        QJsonObject object{{"code", error.code}, {"message", error.message}};
        if (!error.data.isUndefined())
            object.insert("data", error.data);
        if (!advice.isEmpty())
            object.insert("hint", advice.join('\n'));
        return printError(QString::fromUtf8(compactJson(object)) + '\n');
    }
    printError(QString("hermesctl: %1 (%2)\n").arg(error.message).arg(error.code));
    for (const QString &line : advice.isEmpty() ? linesOf(error) : advice)
        printError("  " + line + '\n');
}

int usageError(const QString &text, bool json) {
    if (json)
        tell(Error(ErrorCode::InvalidParams, text), {}, true);
    else
        printError(QString("hermesctl: %1\nhermesctl --help tells what there is\n").arg(text));
    return usageStatus;
}

int finish(const Result<void> &result, const QStringList &advice, const Arguments &arguments) {
    if (result)
        return 0;
    tell(result.error(), advice, arguments.json);
    return 1;
}

int runDaemonCommand(const Subcommand &command, const Arguments &arguments) {
    const QString &daemon = arguments.words.first();
    const auto address = daemonAddress(daemon, arguments.host);
    if (!address)
        return usageError(address.error().message + didYouMean(daemon, daemonNames()), arguments.json);
    Client client;
    const auto connection = connectOnce(client, *address, arguments.timeout);
    if (!connection)
        return connection.error().is(ErrorCode::InvalidParams)
                   ? usageError(connection.error().message, arguments.json)
                   : finish(connection, adviceFor(connection.error(), arguments), arguments);
    const Result<void> result = std::get<DaemonCommand>(command.run)(client, arguments);
    const QStringList advice = result ? QStringList() : adviceFor(result.error(), client, arguments);
    return finish(result, advice, arguments);
}

int runRobotCommand(const Subcommand &command, const Arguments &arguments) {
    const Result<void> result = std::get<RobotCommand>(command.run)(arguments);
    return !result && result.error().is(ErrorCode::InvalidParams)
               ? usageError(result.error().message, arguments.json)
               : finish(result, {}, arguments);
}

QString unknownCommand(const QString &command) {
    const QString first = command.section(' ', 0, 0), list = subcommandNames(first).join(", ");
    if (list.isEmpty())
        return QString("unknown command \"%1\"%2").arg(command, didYouMean(command, subcommandNames()));
    return command == first ? QString("after \"%1\" one of these is expected: %2").arg(first, list)
                            : QString("unknown command \"%1\", there is %2").arg(command, list);
}

int run(Arguments arguments) {
    std::optional<PrivateFiles> owners;
    if (arguments.command.startsWith("keys "))
        owners.emplace();
    const Subcommand *const command = findSubcommand(arguments.command);
    if (!command)
        return usageError(unknownCommand(arguments.command), arguments.json);
    const bool ofAll = arguments.all && command->name() == "doc";
    if (ofAll ? !arguments.words.isEmpty() : !command->takes(arguments.words.size()))
        return usageError(QString("usage: hermesctl %1").arg(command->usage), arguments.json);
    if (const QString foreign = foreignOption(*command, arguments.given); !foreign.isEmpty())
        return usageError(foreign, arguments.json);
    if (arguments.csv && arguments.json)
        return usageError("--csv and --json exclude each other", true);
    setJsonNotes(arguments.json);
    if (arguments.json)
        Progress::useJson();
    if (!arguments.out.isEmpty()) {
        if (const auto opened = setOutput(arguments.out, arguments.force); !opened)
            return finish(opened, {}, arguments);
    }
    if (arguments.command.startsWith("session "))
        arguments.words.prepend(arguments.recorder);
    if (ofAll)
        return finish(documentAll(arguments), {}, arguments);
    const QString first = std::holds_alternative<DaemonCommand>(command->run) ? arguments.words.first() : "";
    if (first.contains('=') && !first.contains(':')) // else it is the query of an address
        return usageError(QString("\"%1\" is no daemon; usage: hermesctl %2").arg(first, command->usage),
                          arguments.json);
    for (int i = 0; i < arguments.words.size(); ++i) {
        const QString &word = arguments.words[i];
        if (command->meaning(i).contains('=') && word.indexOf('=') <= 0)
            return usageError(QString("\"%1\": expected NAME=VALUE").arg(word), arguments.json);
    }
    if (const auto checked = command->check ? command->check(arguments) : Result<void>(); !checked)
        return usageError(checked.error().message, arguments.json);
    return std::holds_alternative<RobotCommand>(command->run) ? runRobotCommand(*command, arguments)
                                                              : runDaemonCommand(*command, arguments);
}

} // namespace

int main(int argc, char **argv) {
    QCoreApplication application(argc, argv);
    prepareConsole();
    outliveClosedPipes(); // who reads stdout may go: that ends a stream in order
    const QStringList list = QCoreApplication::arguments().mid(1);
    if (list.value(0) == "complete")
        return printCandidates(list.value(1));
    const auto arguments = Arguments::parse(list);
    if (!arguments)
        return usageError(arguments.error().message, list.contains("--json"));
    int status = 0;
    if (arguments->help || arguments->command == "help")
        printLine(QString::fromStdString(fittedHelp(helpText().toStdString())).trimmed());
    else if (arguments->version)
        print(*arguments, QJsonObject{{"name", "hermesctl"}, {"version", projectVersion()}},
              "hermesctl " + projectVersion());
    else if (arguments->command.isEmpty())
        status = usageError("a command is missing", arguments->json);
    else
        status = run(*arguments);
    checkOutput();
    return status;
}
