#include "common/daemon/CommandLine.h"

#include "common/settings/DottedPath.h"
#include "protocol/wire/JsonText.h"

#include <QHash>

namespace hermes {

Result<std::pair<QString, QJsonValue>> parseAssignment(const QString &text) {
    const int equals = text.indexOf('=');
    if (equals <= 0)
        return Error(ErrorCode::InvalidParams,
                     QString("\"%1\": expected name=value, as in speed=0.5 or name=run").arg(text));
    const QString value = text.mid(equals + 1);
    const auto json = parseJson(value.toUtf8(), nullptr);
    return std::make_pair(text.left(equals), json ? *json : QJsonValue(value));
}

Result<CommandLine> CommandLine::parse(const QStringList &arguments) {
    static const QHash<QString, Action> actions{{"--print-settings", Action::PrintSettings},
                                                {"--check", Action::Check},
                                                {"--help", Action::Help},
                                                {"-h", Action::Help},
                                                {"--version", Action::Version}};
    CommandLine result;
    for (int i = 0; i < arguments.size(); ++i) {
        const QString &word = arguments.at(i), option = word.section('=', 0, 0);
        if (actions.contains(word)) {
            result.action = actions[word];
            if (result.action == Action::Help || result.action == Action::Version)
                return result;
            continue;
        }
        if (!QStringList{"--config", "--set", "--listen"}.contains(option))
            return Error(ErrorCode::InvalidParams, "unknown option " + word);
        const bool inOne = word.contains('=');
        if (!inOne && ++i == arguments.size())
            return Error(ErrorCode::InvalidParams, QString("option %1 needs a value").arg(option));
        const QString value = inOne ? word.section('=', 1) : arguments.at(i);
        if (value.isEmpty())
            return Error(ErrorCode::InvalidParams,
                         QString("option %1 needs a value that is not empty").arg(option));
        if (option == "--config") {
            result.config = value;
        } else if (option == "--listen") {
            result.listen.append(value);
        } else {
            const auto assignment = parseAssignment(value);
            if (!assignment)
                return Error(ErrorCode::InvalidParams, "option --set " + assignment.error().message);
            result.settings = withValueAt(result.settings, assignment->first, assignment->second);
        }
    }
    return result;
}

QString CommandLine::help() {
    return "  --config FILE      read settings (JSON) from FILE\n"
           "  --set PATH=VALUE   change one setting; may be repeated\n"
           "  --listen URL       listen there instead of where the settings say; may be repeated,\n"
           "                     e.g. tcp://127.0.0.1:7410?protocol=json\n"
           "  --print-settings   print the settings in force as JSON and exit\n"
           "  --check            check the settings and exit\n"
           "  --help             print this and exit\n"
           "  --version          print the version and exit\n";
}

} // namespace hermes
