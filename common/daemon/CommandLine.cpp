#include "common/daemon/CommandLine.h"

#include "common/settings/DottedPath.h"
#include "protocol/wire/JsonText.h"

namespace hermes {

Result<std::pair<QString, QJsonValue>> parseAssignment(const QString &text) {
    const int equals = text.indexOf(QLatin1Char('='));
    if (equals <= 0) {
        return Error(ErrorCode::InvalidParams,
                     QStringLiteral("\"%1\": expected name=value, as in speed=0.5 or name=run").arg(text));
    }
    const QString value = text.mid(equals + 1);
    const auto json = parseJson(value.toUtf8(), nullptr);
    return std::make_pair(text.left(equals), json ? *json : QJsonValue(value));
}

Result<CommandLine> CommandLine::parse(const QStringList &arguments) {
    CommandLine result;
    for (int i = 0; i < arguments.size(); ++i) {
        QString option = arguments.at(i);
        QString value;
        const bool inOne = option.startsWith(QStringLiteral("--")) && option.contains(QLatin1Char('='));
        if (inOne) {
            value = option.section(QLatin1Char('='), 1);
            option = option.section(QLatin1Char('='), 0, 0);
        }
        const bool takesValue =
            QStringList{QStringLiteral("--config"), QStringLiteral("--set"), QStringLiteral("--listen")}
                .contains(option);
        if (takesValue && !inOne) {
            if (++i == arguments.size())
                return Error(ErrorCode::InvalidParams, QStringLiteral("option %1 needs a value").arg(option));
            value = arguments.at(i);
        }
        if (option == QStringLiteral("--config")) {
            result.config = value;
        } else if (option == QStringLiteral("--listen")) {
            result.listen.append(value);
        } else if (option == QStringLiteral("--set")) {
            const auto assignment = parseAssignment(value);
            if (!assignment)
                return Error(ErrorCode::InvalidParams,
                             QStringLiteral("option --set ") + assignment.error().message);
            result.settings = withValueAt(result.settings, assignment->first, assignment->second);
        } else if (option == QStringLiteral("--print-settings") && !inOne) {
            result.action = Action::PrintSettings;
        } else if (option == QStringLiteral("--check") && !inOne) {
            result.action = Action::Check;
        } else if ((option == QStringLiteral("--help") || option == QStringLiteral("-h")) && !inOne) {
            result.action = Action::Help;
            return result;
        } else if (option == QStringLiteral("--version") && !inOne) {
            result.action = Action::Version;
            return result;
        } else {
            return Error(ErrorCode::InvalidParams, QStringLiteral("unknown option %1").arg(arguments.at(i)));
        }
    }
    return result;
}

QString CommandLine::help() {
    return QStringLiteral(
        "  --config FILE      read settings (JSON) from FILE\n"
        "  --set PATH=VALUE   change one setting; may be repeated\n"
        "  --listen URL       listen there instead of where the settings say; may be repeated,\n"
        "                     e.g. tcp://127.0.0.1:7410?protocol=json\n"
        "  --print-settings   print the settings in force as JSON and exit\n"
        "  --check            check the settings and exit\n"
        "  --help             print this and exit\n"
        "  --version          print the version and exit\n");
}

} // namespace hermes
