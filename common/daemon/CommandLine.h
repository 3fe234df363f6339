#pragma once

#include "common/Result.h"

#include <QJsonObject>
#include <QStringList>

namespace hermes {

/// What the command line of a daemon asks for.
struct CommandLine {
    enum class Action { Run, Help, Version, PrintSettings, Check };

    Action action = Action::Run;
    QString config;       ///< settings file, "" for none
    QJsonObject settings; ///< from --set, over the file
    QStringList listen;   ///< from --listen, instead of the setting `listen`

    /// arguments without the program's name. Error: a sentence that names the option.
    static Result<CommandLine> parse(const QStringList &arguments);
    /// The lines of --help about these options.
    static QString help();
};

/// "path=value" with value as JSON where it is JSON, else as a string.
Result<std::pair<QString, QJsonValue>> parseAssignment(const QString &text);

} // namespace hermes
