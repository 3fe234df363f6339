// hermesctl setup: from what is plugged in to settings of the daemons.
#include "protocol/messages/Setup.h"
#include "common/client/DaemonAddress.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/Question.h"
#include "gui/hermesctl/Table.h"
#include "gui/hermesctl/Waiting.h"
#include "gui/hermesctl/WheelTest.h"
#include "gui/setup/SetupText.h"
#include "protocol/wire/Fields.h"

#include <QJsonArray>

namespace hermes::ctl {
namespace {

/// The supervisor, the first of --daemons, else at its default port; the motor control is the second.
Result<void> connectTo(Client &client, const Arguments &arguments, int place, const char *usual) {
    const auto address = daemonAddress(arguments.daemons.value(place, usual), arguments.host);
    if (!address)
        return address.error();
    return connectOnce(client, *address, arguments.timeout);
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

    Result<void> undo() {
        const auto undone = call("setup.undo", {});
        return undone ? tell<Applied>(*undone) : undone.error();
    }

    /// Of a sample, of what was found, or of both.
    Result<void> apply(const QString &sample, const QJsonObject &settings) {
        const auto applied = call("setup.apply", QJsonObject{{"sample", sample}, {"settings", settings}});
        return applied ? tell<Applied>(*applied) : applied.error();
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
    Result<QJsonValue> call(const QString &method, const QJsonObject &params) {
        return ask(supervisor_, arguments_, method, params);
    }

    template <typename T>
    static Result<T> read(const QJsonValue &value, const char *method) {
        ReadReport report;
        auto message = readMessage<T>(WireValue(value), report);
        if (!message)
            return Error(ErrorCode::InternalError, QString("%1: %2").arg(method, report.text()));
        return *std::move(message);
    }

    Result<Findings> find(bool ask, bool release) {
        note("listening and asking; this takes some seconds");
        const auto answer = [&] {
            const Waiting waiting(longestSearch, "searching at most, second");
            return call("setup.find", QJsonObject{{"ask", ask}, {"release", release}});
        }();
        if (!answer)
            return answer.error();
        const auto found = read<Findings>(*answer, "setup.find");
        if (!found)
            return found.error();
        arguments_.json ? printJson(*answer) : show(*found);
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
        const auto answer = call("setup.propose", QJsonObject{{"sample", sample}});
        if (!answer)
            return answer.error();
        auto proposal = read<Proposal>(*answer, "setup.propose");
        if (!proposal)
            return proposal.error();
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

    template <typename T>
    Result<void> tell(const QJsonValue &answer) {
        const auto applied = read<T>(answer, "setup.apply");
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
        const auto answer = call("setup.samples", {});
        if (!answer)
            return answer.error();
        const auto names = read<QStringList>(*answer, "setup.samples");
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

    static constexpr std::chrono::seconds longestSearch{8}; // of setup.find, but for daemons that it ends

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
