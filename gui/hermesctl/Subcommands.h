#pragma once

#include "gui/hermesctl/Commands.h"

namespace hermes::ctl {

/// What a word of a command line stands for.
enum class Word {
    Nothing,
    Daemon,
    Method,
    Parameter,
    SettingPath,
    SettingValue,
    Topic,
    Session,
    Shell,
    Velocity,
    Sample
};

/// A command of hermesctl: how it is called, and what runs it.
struct Subcommand {
    const char *name; ///< two words for those of `record` and `keys`
    int leastWords;
    int maxWords;
    const char *usage;
    const char *summary;
    std::vector<Word> words; ///< the last one stands for those that follow, too
    const char *options;     ///< of its own, separated by spaces
    DaemonCommand ofDaemon;  ///< one of both
    RobotCommand ofRobot;
    RobotCommand check = nullptr; ///< of the command line, before anybody is asked
};

constexpr int anyNumber = 1000000;

/// In the order of the help.
const std::vector<Subcommand> &subcommands();

/// The first words of all, each once.
QStringList subcommandNames();

/// nullptr where there is none.
const Subcommand *findSubcommand(const QString &name);

/// The options of all commands.
QStringList commonOptions();

/// What is wrong with options that are those of other commands; empty: nothing.
QString foreignOption(const Subcommand &command, const QStringList &given);

/// What --help prints.
QString helpText();

} // namespace hermes::ctl
