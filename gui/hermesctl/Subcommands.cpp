#include "gui/hermesctl/Subcommands.h"

namespace hermes::ctl {
namespace {

const char *const helpBegin = R"(Usage: hermesctl [OPTION]... COMMAND ...

Speaks to the daemons of a robot.

)";

const char *const helpEnd = R"(
D is the name of a daemon (at its default port), HOST:PORT, or a URL.

Loggers are the daemons with the command record.start that answer at their default ports.

  --daemons A,B  record, replay, doc --all: these daemons and no others; setup: the supervisor, the motor control
  --host HOST    where daemons given by name run (127.0.0.1)
  --timeout S    the longest wait. Without it 5 s for a connection, 120 s for the other computer of keys pair;
                 for a reply as long as the daemon answers other requests
  --json         one JSON value, or one a line; errors too: {"code", "message", "data", "hint"}
  --out FILE     prints there instead of to stdout; FILE must not exist
  --force        --out: overwrites FILE
  --network      list: who has announced itself on the network (needs Avahi)
  --rate HZ      watch: at most so many messages a second
  --list         setup: only tells what is plugged in (--yes: asks silent lines, too)
  --yes          setup: without questions; the wheels are off the ground
  --undo         setup: puts back what the last one has replaced
  --wheels       setup: only tests the wheels
  --count N      watch: end after N messages; log: the last N records (100)
  --csv          watch: CSV, a column for each value
  --speed X      replay: so many times as fast (1)
  --for S        drive: for so many seconds (10)
  --loop         replay: begin anew at the end
  --role ROLE    keys issue, pair: observer, operator, engineer, or daemon
  --days N       keys issue, pair: valid for so many days (730)
  --port P       keys pair: waits on this port (7499)
  --follow       log: go on with new records
  --all          doc: all daemons on one page
  --help, --version

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

} // namespace

const std::vector<Subcommand> &subcommands() {
    using W = Word;
    static const std::vector<Subcommand> all{
        {"list",
         0,
         0,
         "list",
         "the daemons that answer at their default ports, and what is wrong with them (--network: that "
         "announce themselves)",
         {},
         "--network --daemons",
         nullptr,
         listDaemons},
        {"setup",
         0,
         1,
         "setup [SAMPLE]",
         "finds what is plugged in and writes the settings for it; SAMPLE: those of a whole robot",
         {W::Sample},
         "--list --yes --undo --wheels --daemons",
         nullptr,
         setUp},
        {"stop",
         0,
         anyNumber,
         "stop [D...]",
         "stops all robots that are there, at once, and tells which stand",
         {W::Daemon},
         "",
         nullptr,
         stopRobots},
        {"estop",
         0,
         anyNumber,
         "estop [D...]",
         "the same, and they stay stopped until motor.reset_estop",
         {W::Daemon},
         "",
         nullptr,
         emergencyStopRobots},
        {"record start",
         1,
         1,
         "record start NAME",
         "all loggers begin to record as one session, or none does",
         {W::Nothing},
         "--daemons",
         nullptr,
         recordStart},
        {"record stop",
         0,
         0,
         "record stop",
         "ends it and checks that nothing is missing",
         {},
         "--daemons",
         nullptr,
         recordStop},
        {"record mark",
         1,
         1,
         "record mark TEXT",
         "adds a text with the time to the recording",
         {W::Nothing},
         "--daemons",
         nullptr,
         recordMark},
        {"record status",
         0,
         0,
         "record status",
         "what each logger records",
         {},
         "--daemons",
         nullptr,
         recordStatus},
        {"record list",
         0,
         0,
         "record list",
         "the sessions that were recorded",
         {},
         "--daemons",
         nullptr,
         recordList},
        {"replay",
         1,
         1,
         "replay SESSION",
         "plays a session back through the same topics, until its end or Ctrl-C",
         {W::Session},
         "--daemons --speed --loop",
         nullptr,
         replay},
        {"keys init",
         0,
         0,
         "keys init",
         "makes an authority that signs keys for TLS, and your own keys",
         {},
         "",
         nullptr,
         keysInit},
        {"keys issue",
         1,
         1,
         "keys issue NAME --role ROLE",
         "keys for a person (observer, operator, engineer) or a robot (daemon)",
         {W::Nothing},
         "--role --days",
         nullptr,
         keysIssue},
        {"keys pair",
         1,
         1,
         "keys pair NAME --role ROLE",
         "shows a code, and gives keys to the one computer that joins with it",
         {W::Nothing},
         "--role --days --port",
         nullptr,
         keysPair},
        {"keys join",
         2,
         anyNumber,
         "keys join HOST[:PORT] CODE",
         "gets the keys of this computer where keys pair shows the code",
         {W::Nothing},
         "",
         nullptr,
         keysJoin},
        {"keys revoke",
         1,
         1,
         "keys revoke NAME",
         "revokes the keys of a person or robot, or of a serial number",
         {W::Nothing},
         "",
         nullptr,
         keysRevoke},
        {"keys list", 0, 0, "keys list", "the keys that were issued", {}, "", nullptr, keysList},
        {"discover",
         1,
         1,
         "discover D",
         "the commands and topics of a daemon (--json: its OpenRPC document)",
         {W::Daemon},
         "",
         discover,
         nullptr},
        {"call",
         2,
         anyNumber,
         "call D METHOD [NAME=VALUE]...",
         "calls a command and prints the result; VALUE is JSON, else a string; A.B=VALUE: member B of A",
         {W::Daemon, W::Method, W::Parameter},
         "",
         call,
         nullptr},
        {"get",
         1,
         2,
         "get D [PATH]",
         "all settings, or the value at a path",
         {W::Daemon, W::SettingPath},
         "",
         getSettings,
         nullptr},
        {"set",
         2,
         anyNumber,
         "set D PATH=VALUE...",
         "changes settings: all of them, or none when one is wrong",
         {W::Daemon, W::SettingValue},
         "",
         setSettings,
         nullptr},
        {"watch",
         2,
         2,
         "watch D TOPIC",
         "prints the messages of a topic, one JSON object a line",
         {W::Daemon, W::Topic},
         "--rate --count --csv",
         watch,
         nullptr},
        {"drive",
         1,
         4,
         "drive D [vx=] [vy=] [omega=]",
         "drives with this velocity (m/s, rad/s) for 10 s, for --for S, or until Ctrl-C; without one, by "
         "keys",
         {W::Daemon, W::Velocity},
         "--for",
         drive,
         nullptr,
         checkDrive},
        {"log",
         1,
         1,
         "log D",
         "the last records of the log (--count N; --follow: new ones too)",
         {W::Daemon},
         "--count --follow",
         showLog,
         nullptr},
        {"doc",
         1,
         1,
         "doc D",
         "the reference of a daemon in Markdown (doc --all: of all daemons)",
         {W::Daemon},
         "--all --daemons",
         document,
         nullptr},
        {"completion",
         1,
         1,
         "completion bash|zsh",
         "prints the script that completes command lines",
         {W::Shell},
         "",
         nullptr,
         completion},
    };
    return all;
}

QStringList subcommandNames() {
    QStringList names;
    for (const Subcommand &one : subcommands())
        names.append(QString::fromLatin1(one.name).section(' ', 0, 0));
    names.removeDuplicates();
    return names;
}

const Subcommand *findSubcommand(const QString &name) {
    for (const Subcommand &one : subcommands()) {
        if (name == one.name)
            return &one;
    }
    return nullptr;
}

QStringList commonOptions() {
    return {"--help", "--host", "--timeout", "--json", "--out", "--force"};
}

QString foreignOption(const Subcommand &command, const QStringList &given) {
    const QStringList own = QString::fromLatin1(command.options).split(' ', Qt::SkipEmptyParts);
    for (const QString &option : given)
        if (!commonOptions().contains(option) && !own.contains(option))
            return QString("%1 is no option of \"%2\"%3")
                .arg(option, command.name, own.isEmpty() ? QString() : ", which has " + own.join(", "));
    return {};
}

QString helpText() {
    QString text = helpBegin;
    for (const Subcommand &one : subcommands())
        text += QString("  %1 %2\n").arg(one.usage, -30).arg(one.summary);
    return text + helpEnd;
}

} // namespace hermes::ctl
