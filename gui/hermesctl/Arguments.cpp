#include "gui/hermesctl/Arguments.h"

#include "gui/hermesctl/Nearest.h"

#include <QRegularExpression>
#include <cmath>

namespace hermes::ctl {
namespace {

Result<double> positive(const QString &option, const QString &text) {
    bool ok = false;
    const double value = text.toDouble(&ok);
    if (!ok || !std::isfinite(value) || value <= 0 || value > 1e9)
        return Error(
            ErrorCode::InvalidParams,
            QString("option %1 is \"%2\", expected a number above 0, at most 1e9").arg(option, text));
    return value;
}

struct Flag {
    const char *name;
    bool Arguments::*member;
};

const Flag allFlags[] = {
    {"--csv", &Arguments::csv},         {"--json", &Arguments::json},     {"--follow", &Arguments::follow},
    {"--loop", &Arguments::loop},       {"--all", &Arguments::all},       {"--force", &Arguments::force},
    {"--network", &Arguments::network}, {"--help", &Arguments::help},     {"-h", &Arguments::help},
    {"--version", &Arguments::version}, {"--list", &Arguments::list},     {"--yes", &Arguments::yes},
    {"--undo", &Arguments::undo},       {"--wheels", &Arguments::wheels},
};

bool *flagOf(Arguments &arguments, const QString &option) {
    for (const Flag &flag : allFlags) {
        if (option == flag.name)
            return &(arguments.*flag.member);
    }
    return nullptr;
}

void takeTimeout(Arguments &arguments, double value) {
    arguments.timeout = std::chrono::milliseconds(int(std::min(value, 1e6) * 1000));
    arguments.timeoutIsGiven = true;
}

Result<void> takeWhole(Arguments &arguments, const QString &option, const QString &text, double value) {
    if (value != std::floor(value))
        return Error(ErrorCode::InvalidParams,
                     QString("option %1 is %2, expected a whole number").arg(option, text));
    if (option == "--port" && value > 65535)
        return Error(ErrorCode::InvalidParams,
                     QString("option --port is %1, expected at most 65535").arg(text));
    if (option == "--port")
        arguments.port = int(value);
    else if (option == "--days")
        arguments.days = int(std::min(value, 36500.0));
    else
        arguments.count = int(value);
    return {};
}

Result<void> takeNumber(Arguments &arguments, const QString &option, const QString &text) {
    const auto value = positive(option, text);
    if (!value)
        return value.error();
    if (option == "--rate")
        arguments.rate_hz = *value;
    else if (option == "--speed")
        arguments.speed = *value;
    else if (option == "--for")
        arguments.for_s = std::min(*value, 1e6);
    else if (option == "--timeout")
        takeTimeout(arguments, *value);
    else
        return takeWhole(arguments, option, text, *value);
    return {};
}

Result<void> takeHost(Arguments &arguments, const QString &text) {
    static const QRegularExpression withPort("^[^:]*:[0-9]*$");
    if (text.isEmpty() || withPort.match(text).hasMatch())
        return Error(ErrorCode::InvalidParams,
                     QString("option --host is \"%1\", expected a name or address without a port; a daemon "
                             "at another port is named as HOST:PORT")
                         .arg(text));
    arguments.host = text;
    return {};
}

Result<void> takeValue(Arguments &arguments, const QString &option, const QString &text) {
    if (option == "--host")
        return takeHost(arguments, text);
    if (option == "--out")
        arguments.out = text;
    else if (option == "--role")
        arguments.role = text;
    else if (option == "--daemons")
        arguments.daemons = text.split(',');
    else
        return takeNumber(arguments, option, text);
    return {};
}

} // namespace

QStringList Arguments::flags() {
    QStringList names;
    for (const Flag &flag : allFlags)
        names.append(flag.name);
    return names;
}

QStringList Arguments::optionsWithValue() {
    return {"--rate", "--timeout", "--count", "--speed", "--host", "--daemons",
            "--out",  "--role",    "--days",  "--port",  "--for"};
}

bool hasSecondWord(const QString &command) {
    return command == "record" || command == "keys";
}

Result<Arguments> Arguments::parse(const QStringList &list) {
    Arguments result;
    for (int i = 0; i < list.size(); ++i) {
        const QString &word = list.at(i);
        if (!word.startsWith('-')) {
            if (result.command.isEmpty())
                result.command = word;
            else
                result.words.append(word);
            continue;
        }
        const QString option = word.section('=', 0, 0);
        result.given.append(option);
        bool *const flag = flagOf(result, word);
        if (flag) {
            *flag = true;
            continue;
        }
        if (!optionsWithValue().contains(option))
            return Error(
                ErrorCode::InvalidParams,
                QString("unknown option %1%2").arg(word, didYouMean(option, flags() + optionsWithValue())));
        const bool inOne = word.contains('=');
        if (!inOne && i + 1 == list.size())
            return Error(ErrorCode::InvalidParams, QString("option %1 needs a value").arg(option));
        const QString value = inOne ? word.section('=', 1) : list.at(++i);
        const auto taken = takeValue(result, option, value);
        if (!taken)
            return taken.error();
    }
    return result;
}

} // namespace hermes::ctl
