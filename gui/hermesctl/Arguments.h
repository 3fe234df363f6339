#pragma once

#include "common/Result.h"

#include <QStringList>
#include <chrono>
#include <vector>

namespace hermes::ctl {

/// The command line of hermesctl.
struct Arguments {
    QString command;   ///< two words for `session start` and its like
    QStringList words; ///< what follows the command, options taken out
    QString host = "127.0.0.1";
    std::chrono::milliseconds timeout{5000};
    bool timeoutIsGiven = false;
    double rate_hz = 0; ///< 0: every message
    int count = 0;      ///< 0: without end
    int days = 2 * 365; ///< that keys are valid
    int port = 0;       ///< 0: the usual one
    QString role;
    QString base; ///< the motor control that turns a scanner
    double speed = 1;
    double for_s = 0;              ///< 0: without end
    QStringList given;             ///< names of all options, as they came
    QStringList daemons;           ///< speak to these; empty: to those at their default ports
    QString recorder = "recorder"; ///< who records and replays sessions
    QStringList without, topics;
    QString name, topic; ///< of a session that is imported, of the scanner in its bag
    QString format;
    QString profile;
    QString scanner, world, kinematics = "mecanum"; ///< of a simulated robot
    double at_s = 0, from_s = 0;
    bool detach = false;
    QString out;        ///< file instead of stdout
    bool force = false; ///< overwrites it
    bool all = false;
    bool network = false;
    bool loop = false;
    bool list = false;
    bool yes = false;
    bool undo = false;
    bool wheels = false;
    bool csv = false;
    bool json = false;
    bool follow = false;
    bool help = false;
    bool version = false;

    /// arguments without the program's name. Error: a sentence that names the option.
    static Result<Arguments> parse(const QStringList &arguments);
    /// The next one that is no option.
    void takeWord(const QString &word);
};

/// An option of hermesctl, or a short name of one.
struct Option {
    const char *usage;   ///< "--count N": its name, and what has to follow
    const char *summary; ///< empty: --help has no line of it
    /// Puts the text that follows the option into the arguments; gives what is wrong with it, or nothing.
    QString (*take)(Arguments &arguments, const QString &text);

    QString name() const { return QString(usage).section(' ', 0, 0); }
    bool hasValue() const { return name() != usage; }
};

/// In the order of the help.
const std::vector<Option> &options();

/// nullptr where there is none.
const Option *findOption(const QString &name);

} // namespace hermes::ctl
