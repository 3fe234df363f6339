#include "gui/hermesctl/Arguments.h"

#include "gui/hermesctl/Nearest.h"
#include "gui/hermesctl/Subcommands.h"

#include <QRegularExpression>
#include <algorithm>
#include <cmath>

namespace hermes::ctl {
namespace {

/// What is wrong with the text of a number, or nothing.
QString readNumber(const QString &text, double &value, bool mayBe0 = false) {
    bool ok = false;
    value = text.toDouble(&ok);
    const bool isGood = ok && std::isfinite(value) && (value > 0 || (mayBe0 && value == 0)) && value <= 1e9;
    return isGood
               ? QString()
               : QString("\"%1\", expected a number %2 0, at most 1e9").arg(text, mayBe0 ? "from" : "above");
}

/// A flag, a text or a number; a number above `most` counts as that.
template <auto member, int most = 1000000000, bool mayBe0 = false>
QString take(Arguments &arguments, const QString &text) {
    auto &place = arguments.*member;
    using Value = std::decay_t<decltype(place)>;
    if constexpr (std::is_same_v<Value, bool>) {
        place = true;
    } else if constexpr (std::is_same_v<Value, QString>) {
        place = text;
    } else {
        double value = 0;
        if (const QString wrong = readNumber(text, value, mayBe0); !wrong.isEmpty())
            return wrong;
        if (std::is_same_v<Value, int> && value != std::floor(value))
            return text + ", expected a whole number";
        place = Value(std::min(value, double(most)));
    }
    return {};
}

QString takePort(Arguments &arguments, const QString &text) {
    const QString wrong = take<&Arguments::port>(arguments, text);
    return wrong.isEmpty() && arguments.port > 65535 ? text + ", expected at most 65535" : wrong;
}

QString takeTimeout(Arguments &arguments, const QString &text) {
    double seconds = 0;
    if (const QString wrong = readNumber(text, seconds); !wrong.isEmpty())
        return wrong;
    arguments.timeout = std::chrono::milliseconds(int(std::min(seconds, 1e6) * 1000));
    arguments.timeoutIsGiven = true;
    return {};
}

QString takeHost(Arguments &arguments, const QString &text) {
    static const QRegularExpression withPort("^[^:]*:[0-9]*$");
    if (text.isEmpty() || withPort.match(text).hasMatch())
        return '"' + text +
               "\", expected a name or address without a port; a daemon at another port is named as "
               "HOST:PORT";
    arguments.host = text;
    return {};
}

template <auto member>
QString takeList(Arguments &arguments, const QString &text) {
    arguments.*member = text.split(',');
    return {};
}

Error wrongUsage(const QString &text) {
    return {ErrorCode::InvalidParams, text};
}

} // namespace

const std::vector<Option> &options() {
    static const std::vector<Option> all{
        {"--daemons A,B",
         "list, doc --all: these daemons and no others; session start: these loggers; setup: the supervisor, "
         "the "
         "motor control",
         takeList<&Arguments::daemons>},
        {"--recorder D", "session: this recorder, not the one at its default port",
         take<&Arguments::recorder>},
        {"--host HOST", "where daemons given by name run (127.0.0.1)", takeHost},
        {"--timeout S",
         "the longest wait. Without it 5 s for a connection, 120 s for the other computer of keys pair; for "
         "a reply as long as the daemon answers other requests",
         takeTimeout},
        {"--json", "one JSON value, or one a line; errors too: {\"code\", \"message\", \"data\", \"hint\"}",
         take<&Arguments::json>},
        {"--out FILE", "prints there instead of to stdout; FILE must not exist", take<&Arguments::out>},
        {"--force", "--out: overwrites FILE", take<&Arguments::force>},
        {"--network", "list: who has announced itself on the network (needs Avahi)",
         take<&Arguments::network>},
        {"--rate HZ", "watch: at most so many messages a second", take<&Arguments::rate_hz>},
        {"--list", "setup: only tells what is plugged in (--yes: asks silent lines, too)",
         take<&Arguments::list>},
        {"--yes",
         "setup, conform: without questions; the wheels are off the ground; session remove: without one",
         take<&Arguments::yes>},
        {"--base D",
         "conform scanner: has this motor control turn the robot on the spot; simulate: what drives it: "
         "roboclaw, arduino, vesc, opencr or roboteq",
         take<&Arguments::base>},
        {"--undo", "setup: puts back what the last one has replaced", take<&Arguments::undo>},
        {"--wheels", "setup: only tests the wheels", take<&Arguments::wheels>},
        {"--count N", "watch: end after N messages; log: the last N records (100); session list: the last N",
         take<&Arguments::count>},
        {"--csv", "watch: CSV, a column for each value", take<&Arguments::csv>},
        {"--speed X", "replay: so many times as fast (1)", take<&Arguments::speed>},
        {"--for S", "drive: for so many seconds (10)", take<&Arguments::for_s, 1000000>},
        {"--from S", "replay: begin at this second of the session (0)",
         take<&Arguments::from_s, 1000000000, true>},
        {"--loop", "replay: begin anew at the end", take<&Arguments::loop>},
        {"--without A,B", "replay: these daemons stay live", takeList<&Arguments::without>},
        {"--detach", "replay: the recorder goes on alone; session live ends it", take<&Arguments::detach>},
        {"--at S", "session explain: what was at this second of the session",
         take<&Arguments::at_s, 1000000000, true>},
        {"--format F", "session export: csv, tum, carmen, mcap or pcap", take<&Arguments::format>},
        {"--profile P", "session export --format mcap: ros2, a bag of ROS 2", take<&Arguments::profile>},
        {"--topics A,B", "session export: these topics and no others, as motorcontrol/odometry",
         takeList<&Arguments::topics>},
        {"--name NAME", "session import: its name (that of the bag)", take<&Arguments::name>},
        {"--topic TOPIC", "session import: of several scanners in the bag this one", take<&Arguments::topic>},
        {"--role ROLE", "keys issue, pair, ros2: observer, operator, engineer, or daemon",
         take<&Arguments::role>},
        {"--days N", "keys issue, pair, ros2: valid for so many days (730)", take<&Arguments::days, 36500>},
        {"--port P", "keys pair: waits on this port (7499)", takePort},
        {"--scanner MODEL", "simulate: with this 2D scanner in place of the HDL-32E, as ld06",
         take<&Arguments::scanner>},
        {"--world FILE", "simulate: in this world (a room with pillars)", take<&Arguments::world>},
        {"--kinematics KIND",
         "simulate: mecanum, differential, two_wheels, omni3 or omni4; with another --base than roboclaw "
         "differential or "
         "two_wheels, with vesc ackermann, too",
         take<&Arguments::kinematics>},
        {"--follow", "log: go on with new records", take<&Arguments::follow>},
        {"--all", "doc: all daemons on one page", take<&Arguments::all>},
        {"--help", "", take<&Arguments::help>},
        {"-h", "", take<&Arguments::help>},
        {"--version", "", take<&Arguments::version>},
    };
    return all;
}

const Option *findOption(const QString &name) {
    const auto found = std::find_if(options().begin(), options().end(),
                                    [&name](const Option &option) { return option.name() == name; });
    return found == options().end() ? nullptr : &*found;
}

void Arguments::takeWord(const QString &word) {
    if (command.isEmpty())
        command = withoutShortName(word);
    else if (!subcommandNames(command).isEmpty())
        command += ' ' + word;
    else
        words.append(word);
}

Result<Arguments> Arguments::parse(const QStringList &list) {
    Arguments result;
    for (int i = 0; i < list.size(); ++i) {
        const QString &word = list.at(i);
        if (!word.startsWith('-')) {
            result.takeWord(word);
            continue;
        }
        const QString name = word.section('=', 0, 0);
        const bool inOne = word.contains('=');
        const Option *const option = findOption(name);
        if (!option || (inOne && !option->hasValue())) {
            QStringList names;
            for (const Option &one : options())
                names.append(one.name());
            std::stable_sort(names.begin(), names.end(), // of those as near, the longest one is meant
                             [](const QString &a, const QString &b) { return a.size() > b.size(); });
            return wrongUsage("unknown option " + word + didYouMean(name, names));
        }
        result.given.append(name);
        QString text = word.section('=', 1);
        if (option->hasValue() && !inOne) {
            if (++i == list.size())
                return wrongUsage("option " + name + " needs a value");
            text = list.at(i);
        }
        if (const QString wrong = option->take(result, text); !wrong.isEmpty())
            return wrongUsage("option " + name + " is " + wrong);
    }
    return result;
}

} // namespace hermes::ctl
