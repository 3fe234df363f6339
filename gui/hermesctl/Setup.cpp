// hermesctl setup: from what is plugged in to settings of the daemons.
#include "protocol/messages/Setup.h"
#include "common/client/DaemonAddress.h"
#include "common/daemon/SignalWatcher.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/Question.h"
#include "gui/hermesctl/Waiting.h"
#include "gui/setup/SetupText.h"
#include "gui/setup/WheelSettings.h"
#include "gui/setup/WheelTurn.h"
#include "protocol/wire/Fields.h"

#include <QEventLoop>
#include <QHostInfo>
#include <optional>

namespace hermes::ctl {
namespace {

/// The supervisor, the first of --daemons, else at its default port; the motor control is the second.
Result<void> connectTo(Client &client, const Arguments &arguments, int place, const char *usual) {
    const auto address = daemonAddress(arguments.daemons.value(place, usual), arguments.host);
    if (!address)
        return address.error();
    return connectOnce(client, *address, arguments.timeout);
}

const QString choices =
    "Enter: it turned forward; b: backward; fl, fr, rl, rr: that one turned instead (flb: "
    "backward); n: none; q: give up";

QString initials(const QString &wheel) {
    return wheel.left(1) + wheel.section('_', 1).left(1);
}

/// The mean speed that the encoder of a wheel tells while it turns, in rad/s.
Result<double> turn(Client &motors, const Arguments &arguments, const QString &wheel, double speed) {
    QEventLoop loop;
    Result<double> measured = 0.0;
    WheelTurn turn(motors, "hermesctl on " + QHostInfo::localHostName(), arguments.timeout);
    SignalWatcher signals(nullptr);
    QObject::connect(&signals, &SignalWatcher::received, &turn, &WheelTurn::giveUp);
    turn.begin(wheel, speed, [&](const Result<double> &result) {
        measured = result;
        loop.quit();
    });
    loop.exec();
    return measured;
}

/// "": as told; "b": backward; "fl", "fr", "rl", "rr": that one instead, with a "b" behind it backward; "n":
/// none. Nothing for all else.
std::optional<SeenWheel> seenWheel(const QString &told, const QString &answer) {
    if (answer == "n")
        return SeenWheel{};
    if (answer.isEmpty() || answer == "b")
        return SeenWheel{told, answer == "b"};
    for (const QString &wheel : wheelNames())
        if (answer == initials(wheel) || answer == initials(wheel) + 'b')
            return SeenWheel{wheel, answer.size() == 3};
    return std::nullopt;
}

/// Turns each wheel slowly for a second and asks what a person has seen; gives the settings `wheels` that are
/// to change. The robot stands when it is back. Error: the test was given up.
Result<QJsonObject> testWheels(Client &motors, const Arguments &arguments) {
    const auto settings = motors.callAndWait("settings.get", QJsonObject(), arguments.timeout);
    if (!settings)
        return settings.error();
    const auto state = motors.callAndWait("motor.state", QJsonObject(), arguments.timeout);
    if (!state)
        return state.error();
    const auto plan = WheelPlan::from(settings->toObject(), state->toObject());
    if (!plan)
        return plan.error();
    std::map<QString, SeenWheel> seen;
    for (const QString &wheel : plan->wheels) {
        note(QString("%1 is told to turn forward, at %2 rad/s for %3 s")
                 .arg(wheel)
                 .arg(plan->speed)
                 .arg(WheelTurn::turn_s));
        const auto measured = turn(motors, arguments, wheel, plan->speed);
        if (!measured)
            return measured.error();
        note(QString("its encoder tells %1 rad/s").arg(*measured, 0, 'f', 2));
        std::optional<SeenWheel> one;
        while (!one) {
            const QString answer = answerTo(QString("What turned? %1:").arg(choices));
            if (answer == "q")
                return Error(ErrorCode::NotReady, "the test of the wheels was given up");
            one = seenWheel(wheel, answer);
        }
        seen[wheel] = *one;
    }
    return wheelSettings(plan->settings, seen);
}

class SetUp {
public:
    SetUp(Client &supervisor, const Arguments &arguments)
        : supervisor_(supervisor)
        , arguments_(arguments) {}

    Result<void> list() {
        const auto found = find(arguments_.yes, arguments_.yes);
        return found ? Result<void>() : found.error();
    }

    Result<void> undo() { return change("setup.undo", {}); }

    /// Of a sample, of what was found, or of both.
    Result<void> apply(const QString &sample, const QJsonObject &settings) {
        return change("setup.apply", {{"sample", sample}, {"settings", settings}});
    }

    /// Without questions; the settings of now are changed.
    Result<void> withoutQuestions() {
        if (const auto found = find(true, true); !found)
            return found.error();
        const auto proposal = propose({});
        if (!proposal)
            return proposal.error();
        return proposal->settings.isEmpty() ? Result<void>() : apply({}, proposal->settings);
    }

    Result<void> withQuestions() {
        const auto sample = chooseSample();
        if (!sample)
            return sample.error();
        const bool mayRelease = isConfirmed(
            "May the daemons that use serial lines or hear lidars be ended for the search, and started "
            "again?\n"
            "The robot stands then, and what they record ends. Otherwise their devices are left alone.");
        const bool mayAsk = isConfirmed("May silent lines be asked whether they lead to a RoboClaw? Another "
                                        "motor controller may take that for a speed:\n"
                                        "are the wheels off the ground, or the motors without power?");
        if (const auto found = find(mayAsk, mayRelease); !found)
            return found.error();
        const auto proposal = propose(*sample);
        if (!proposal)
            return proposal.error();
        if (proposal->changes.empty())
            note("nothing needs a change");
        else if (!isConfirmed("Write these settings?"))
            return Error(ErrorCode::NotReady, "nothing was changed");
        else if (const auto applied = apply(*sample, proposal->settings); !applied)
            return applied;
        return hasMotors(*proposal) && isConfirmed("Test the wheels?") ? wheels() : Result<void>();
    }

    Result<void> wheels() {
        if (answerTo("Each wheel turns slowly for a second. Lift the robot: no wheel may touch the ground, "
                     "and nobody may touch a wheel.\nType \"lifted\" when that is so:") != "lifted")
            return Error(ErrorCode::NotReady, "no wheel was turned: the robot is not lifted");
        Client motors;
        if (const auto connected = connectTo(motors, arguments_, 1, "motorcontrol"); !connected)
            return connected;
        const auto changes = testWheels(motors, arguments_);
        if (!changes)
            return changes.error();
        if (changes->isEmpty()) {
            note("all wheels turn as they are told; nothing needs a change");
            return {};
        }
        const QJsonObject settings{{"motorcontrol", QJsonObject{{"wheels", *changes}}}};
        show(changesOf(settings));
        if (!isConfirmed("Write these settings?"))
            return Error(ErrorCode::NotReady, "nothing was changed");
        return apply({}, settings);
    }

private:
    /// raw: the answer as it came.
    template <typename T>
    Result<T> call(const QString &method, const QJsonObject &params, QJsonValue *raw = nullptr) {
        const auto answer = ask(supervisor_, arguments_, method, params);
        if (!answer)
            return answer.error();
        if (raw)
            *raw = *answer;
        ReadReport report;
        auto message = readMessage<T>(WireValue(*answer), report);
        if (!message)
            return Error(ErrorCode::InternalError, QString("%1: %2").arg(method, report.text()));
        return *std::move(message);
    }

    Result<Findings> find(bool ask, bool release) {
        note("listening and asking; this takes some seconds");
        QJsonValue answer;
        const auto found = [&] {
            const Waiting waiting(longestSearch, "searching at most, second");
            return call<Findings>("setup.find", {{"ask", ask}, {"release", release}}, &answer);
        }();
        if (found)
            arguments_.json ? printJson(answer) : show(*found);
        return found;
    }

    static void show(const Findings &found) {
        std::vector<QStringList> rows = rowsOf(found, "--yes");
        rows.insert(rows.begin(), {"what", "where", "details"});
        if (rows.size() > 1)
            printTable(rows);
        else
            note("nothing was found");
    }

    Result<Proposal> propose(const QString &sample) {
        const auto proposal = call<Proposal>("setup.propose", {{"sample", sample}});
        if (!proposal)
            return proposal;
        for (const QString &text : proposal->notes)
            note(text);
        if (!arguments_.json)
            show(proposal->changes);
        return proposal;
    }

    /// A line for each setting.
    static void show(const std::vector<SettingChange> &changes) {
        for (const SettingChange &change : changes)
            printLine(QString("%1 %2 = %3%4")
                          .arg(change.daemon, change.path,
                               change.value.isEmpty() ? "(default)" : change.value,
                               change.now.isEmpty() ? QString() : QString("  (now %1)").arg(change.now)));
    }

    /// Tells what was done.
    Result<void> change(const QString &method, const QJsonObject &params) {
        QJsonValue answer;
        const auto applied = call<Applied>(method, params, &answer);
        if (!applied)
            return applied.error();
        if (arguments_.json) {
            printJson(answer);
            return {};
        }
        for (const QString &file : applied->files)
            printLine("written: " + file);
        for (const QString &name : applied->restarted)
            printLine("started: " + name);
        for (const QString &text : applied->notes)
            note(text);
        return {};
    }

    Result<QString> chooseSample() {
        const auto names = call<QStringList>("setup.samples", {});
        if (!names)
            return names.error();
        while (true) {
            const QString name = answerTo(
                QString("Which robot is it? %1; Enter: change the present settings:").arg(names->join(", ")));
            if (name == "q")
                return Error(ErrorCode::NotReady, "nothing was changed");
            if (name.isEmpty() || names->contains(name))
                return name;
        }
    }

    static bool hasMotors(const Proposal &proposal) { return proposal.settings.contains("motorcontrol"); }

    static constexpr std::chrono::seconds longestSearch{15}; // of setup.find, but for daemons that it ends

    Client &supervisor_;
    const Arguments &arguments_;
};

} // namespace

Result<void> setUp(const Arguments &arguments) {
    const QString sample = arguments.words.value(0);
    const int ways =
        int(arguments.list) + int(arguments.undo) + int(arguments.wheels) + int(!sample.isEmpty());
    if (ways > 1)
        return Error(ErrorCode::InvalidParams, "SAMPLE, --list, --undo and --wheels exclude each other");
    const bool asks = arguments.wheels || (ways == 0 && !arguments.yes);
    if (asks && !canAsk())
        return Error(ErrorCode::InvalidParams,
                     "setup asks questions, and this is no terminal: --yes, --list, or a SAMPLE");
    Client supervisor;
    if (const auto connected = connectTo(supervisor, arguments, 0, "supervisor"); !connected)
        return Error(
            connected.error().is(ErrorCode::InvalidParams) ? ErrorCode::InvalidParams
                                                           : ErrorCode::Disconnected,
            connected.error().message +
                "; the supervisor of the robot does the work (systemctl start hermes-supervisor there)");
    SetUp setup(supervisor, arguments);
    if (arguments.list)
        return setup.list();
    if (arguments.undo)
        return setup.undo();
    if (arguments.wheels)
        return setup.wheels();
    if (!sample.isEmpty())
        return setup.apply(sample, {});
    return arguments.yes ? setup.withoutQuestions() : setup.withQuestions();
}

} // namespace hermes::ctl
