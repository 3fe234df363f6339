#pragma once

#include "gui/hermesctl/Commands.h"

#include <variant>

namespace hermes::ctl {

/// A command of hermesctl: how it is called, and what runs it.
struct Subcommand {
    /// As "get D [PATH]": its name, the words that have to follow, and in brackets those that may; "..."
    /// after the last one stands for more like it.
    const char *usage;
    const char *summary;
    const char *ownOptions;                                      ///< separated by spaces
    std::variant<DaemonCommand, RobotCommand, const char *> run; ///< or the command that it is short for
    RobotCommand check = nullptr; ///< of the command line, before anybody is asked

    QString name() const; ///< two words for those of `session` and `keys`
    QStringList options() const;
    bool takes(int words) const; ///< whether so many words may follow the name
    /// What the word at a place after the name stands for: "D", "PATH=VALUE"; empty where there is none.
    QString meaning(int place) const;

private:
    QStringList words() const;
};

/// In the order of the help.
const std::vector<Subcommand> &subcommands();

/// The first words of all, each once; or the second words of those that begin with one, as `session`.
QStringList subcommandNames(const QString &first = {});

/// nullptr where there is none.
const Subcommand *findSubcommand(const QString &name);

/// The command that `record` or `replay` is short for; any other word stays.
QString withoutShortName(const QString &word);

/// The options of all commands.
QStringList commonOptions();

/// What is wrong with options that are those of other commands; empty: nothing.
QString foreignOption(const Subcommand &command, const QStringList &given);

/// What --help prints.
QString helpText();

} // namespace hermes::ctl
