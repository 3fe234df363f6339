#include "gui/hermesctl/Subcommands.h"

#include "gui/hermesctl/Import.h"

#include <QRegularExpression>
#include <algorithm>

namespace hermes::ctl {
namespace {

const char *const helpBegin = R"(Usage: hermesctl [OPTION]... COMMAND ...

Speaks to the daemons of a robot.

)";

const char *const helpMiddle = R"(
D is the name of a daemon (at its default port), HOST:PORT, or a URL.

)";

const char *const helpEnd = R"(  --help, --version

Exit status: 0 success, 2 wrong usage, 1 any other failure.

Examples:
  hermesctl setup --list
  hermesctl call scanmatcher daemon.status
  hermesctl set velodynelogger limits.clients=20
  hermesctl record start run1
  hermesctl drive motorcontrol vx=0.2 --for 2
  hermesctl estop
  hermesctl watch scanmatcher pose --rate 5 --csv --out pose.csv
  source <(hermesctl completion bash)
)";

template <typename Entry>
QString helpLine(const Entry &entry, int width) {
    return "  " + QString(entry.usage).leftJustified(width) + ' ' + entry.summary + '\n';
}

} // namespace

QString Subcommand::name() const {
    static const QRegularExpression form("^[a-z]+( [a-z]+[0-9]*)?(?![^ ])");
    return form.match(usage).captured();
}

QStringList Subcommand::options() const {
    return QString(ownOptions).split(' ', Qt::SkipEmptyParts);
}

QStringList Subcommand::words() const {
    return QString(usage).mid(name().size()).section(" --", 0, 0).split(' ', Qt::SkipEmptyParts);
}

bool Subcommand::takes(int count) const {
    const QStringList all = words();
    const auto least = std::count_if(all.begin(), all.end(), [](auto &word) { return word[0] != '['; });
    return count >= least && (count <= all.size() || !meaning(count - 1).isEmpty());
}

QString Subcommand::meaning(int place) const {
    const QStringList all = words();
    const bool goesOn = QString(usage).contains("...") || all.contains("CODE"); // which may be in parts
    const QString word = goesOn ? all.value(place, all.last()) : all.value(place);
    return QString(word).remove("...").remove('[').remove(']');
}

const std::vector<Subcommand> &subcommands() {
    static const std::vector<Subcommand> all{
        {"list",
         "the daemons that answer at their default ports, and what is wrong with them (--network: that "
         "announce themselves)",
         "--network --daemons", listDaemons},
        {"setup [SAMPLE]",
         "finds what is plugged in and writes the settings for it; SAMPLE: those of a whole robot",
         "--list --yes --undo --wheels --daemons", setUp},
        {"simulate", "starts a whole simulated robot on this computer, until Ctrl-C",
         "--scanner --base --world --kinematics", simulate, checkSimulate},
        {"stop [D...]", "stops all robots that are there, at once, and tells which stand", "", stopRobots},
        {"estop [D...]", "the same, and they stay stopped until motor.reset_estop", "", emergencyStopRobots},
        {"session start [NAME]", "the recorder begins to record all of the robot, or nothing begins",
         "--recorder --daemons", session},
        {"session stop", "ends it and tells what is missing", "--recorder", session},
        {"session mark TEXT", "adds a text with the time to what is recorded", "--recorder", session},
        {"session status", "what is recorded or replayed now", "--recorder", session},
        {"session list", "those that were recorded, the latest first", "--recorder --count", session},
        {"session info SESSION", "its length, way, topics, marks, stops and faults", "--recorder", session},
        {"session replay SESSION", "plays it back through the same topics, until its end or Ctrl-C",
         "--recorder --speed --from --loop --without --detach", session},
        {"session live", "ends a replay", "--recorder", session},
        {"session explain SESSION", "who drove, and why the robot stopped", "--recorder --at", session},
        {"session export SESSION --format F", "writes files for other programs beside it, and tells which",
         "--recorder --format --profile --topics", session},
        {"session import BAG", "makes a session of a bag of ROS, which replays", "--recorder --name --topic",
         importSession},
        {"session rename SESSION NAME", "gives it another name", "--recorder", session},
        {"session remove SESSION", "removes it, after a question", "--recorder --yes", session},
        {"record ...", "short for session: record start, record stop, ...", "", "session"},
        {"replay SESSION", "short for session replay", "", "session replay"},
        {"keys init", "makes an authority that signs keys for TLS, and your own keys", "", keysInit},
        {"keys issue NAME --role ROLE",
         "keys for a person (observer, operator, engineer) or a robot (daemon)", "--role --days", keysIssue,
         checkKeyRole},
        {"keys pair NAME --role ROLE", "shows a code, and gives keys to the one computer that joins with it",
         "--role --days --port", keysPair, checkKeyRole},
        {"keys join HOST[:PORT] CODE", "gets the keys of this computer where keys pair shows the code", "",
         keysJoin},
        {"keys revoke NAME", "revokes the keys of a person or robot, or of a serial number", "", keysRevoke},
        {"keys list", "the keys that were issued", "", keysList},
        {"keys ros2 KEYSTORE NAME --role ROLE",
         "keys for DDS security, in a keystore of SROS2, for a robot (daemon) or a laptop that commands "
         "(operator) or looks (observer)",
         "--role --days", keysRos, checkKeyRole},
        {"discover D", "the commands and topics of a daemon (--json: its OpenRPC document)", "", discover},
        {"call D METHOD [NAME=VALUE]...",
         "calls a command and prints the result; VALUE is JSON, else a string; A.B=VALUE: member B of A", "",
         call},
        {"get D [PATH]", "all settings, or the value at a path", "", getSettings},
        {"set D PATH=VALUE...", "changes settings: all of them, or none when one is wrong", "", setSettings},
        {"watch D TOPIC", "prints the messages of a topic, one JSON object a line", "--rate --count --csv",
         watch},
        {"drive D [vx=] [vy=] [omega=]",
         "drives with this velocity (m/s, rad/s) for 10 s, for --for S, or until Ctrl-C; without one, by "
         "keys",
         "--for", drive, checkDrive},
        {"conform motor D", "tries what a robot base of your own has to do, which turns its wheels", "--yes",
         conformMotor},
        {"conform scanner D", "tries what a laser scanner of your own has to do", "--yes --base",
         conformScanner},
        {"log D", "the last records of the log (--count N; --follow: new ones too)", "--count --follow",
         showLog},
        {"doc D", "the reference of a daemon in Markdown (doc --all: of all daemons)", "--all --daemons",
         document},
        {"completion bash|zsh", "prints the script that completes command lines", "", completion},
    };
    return all;
}

QStringList subcommandNames(const QString &first) {
    const QString begin = first.isEmpty() ? QString() : first + ' ';
    QStringList names;
    for (const Subcommand &one : subcommands())
        if (one.name().startsWith(begin))
            names.append(one.name().mid(begin.size()).section(' ', 0, 0));
    names.removeDuplicates();
    return names;
}

const Subcommand *findSubcommand(const QString &name) {
    for (const Subcommand &one : subcommands()) {
        if (name == one.name())
            return &one;
    }
    return nullptr;
}

QString withoutShortName(const QString &word) {
    const Subcommand *const command = findSubcommand(word);
    const auto *const meaning = command ? std::get_if<const char *>(&command->run) : nullptr;
    return meaning ? *meaning : word;
}

QStringList commonOptions() {
    return {"--help", "--host", "--timeout", "--json", "--out", "--force"};
}

QString foreignOption(const Subcommand &command, const QStringList &given) {
    const QStringList own = command.options();
    for (const QString &option : given)
        if (!commonOptions().contains(option) && !own.contains(option))
            return QString("%1 is no option of \"%2\"%3")
                .arg(option, command.name(), own.isEmpty() ? QString() : ", which has " + own.join(", "));
    return {};
}

QString helpText() {
    QString text = helpBegin;
    for (const Subcommand &one : subcommands())
        text += helpLine(one, 30);
    text += helpMiddle;
    for (const Option &one : options())
        if (*one.summary != '\0')
            text += helpLine(one, 14);
    return text + helpEnd;
}

} // namespace hermes::ctl
