#include "daemons/supervisor/Supervisor.h"

#include "common/OwnRobot.h"
#include "common/Project.h"
#include "daemons/supervisor/RobotId.h"
#include "protocol/wire/Fields.h"

#include <QHostInfo>
#include <QSet>

namespace hermes::supervisor {
namespace {

// A name will do.
QJsonObject entrySchema() {
    QJsonObject schema = schemaOf<ProcessEntry>();
    schema["required"] = QJsonArray{"name"};
    return schema;
}

/// Of what the schema has let pass. What is not said follows from the name: hermes-NAME at its usual port.
ProcessEntry toEntry(const QJsonObject &json) {
    const QString name = json["name"].toString();
    ProcessEntry entry{name, "hermes-" + name, {}, defaultPort(name)};
    ReadReport report;
    fieldsOf<ProcessEntry>().read(WireValue(json), &entry, report);
    return entry;
}

Error noProcess(const QString &name) {
    return invalidParams({{"name", name, "the name of a process"}}, QString("no process \"%1\"").arg(name));
}

/// Its health item.
QString itemOf(const SupervisedProcess &process) {
    return "process " + process.entry().name;
}

std::vector<SchemaViolation> namesAreUnique(const QJsonObject &settings) {
    std::vector<SchemaViolation> violations;
    QSet<QString> names;
    const QJsonArray entries = settings["processes"].toArray();
    for (int i = 0; i < entries.size(); ++i) {
        const QString name = entries[i].toObject()["name"].toString();
        if (names.contains(name))
            violations.push_back(
                {QString("processes.%1.name").arg(i), name, "a name that no other process has"});
        names.insert(name);
    }
    return violations;
}

} // namespace

Supervisor::Supervisor()
    : Daemon({"supervisor", "Supervisor", "Starts the daemons of this host and keeps them running"}) {
    runWithWrongFile();
    declareSettings();
    declareCommands();
    setup_ = std::make_unique<Setup>(
        settings(),
        [this] {
            std::vector<SupervisedProcess *> all;
            for (const auto &process : processes_)
                all.push_back(process.get());
            return all;
        },
        nullptr);
    addCommands(setup_->commands());
    addTopic(Topic("processes", "What process.list gives, each second and at each change")
                 .carries<ProcessesMessage>()
                 .snapshot([this] { return Outgoing(list()); }));
    connect(&timer_, &QTimer::timeout, this, [this] {
        for (const auto &process : processes_)
            process->measure();
        update();
    });
}

void Supervisor::declareSettings() {
    addSetting(Field::text("robot", "What people call this robot; empty: the name of the host")
                   .group("Robot")
                   .byDefault(""));
    addSetting(
        Field::array(
            "processes",
            "What runs here, in the order of their start; a name will do: hermes-NAME at its usual port",
            entrySchema())
            .group("Processes")
            .byDefault(usualProcesses()));
    settings().addRule(namesAreUnique);
}

void Supervisor::declareCommands() {
    addCommand(Command("process.list", "All processes, how they are and what they use")
                   .needs(Role::Observer)
                   .answers([this](const Call &) { return list(); }));
    addCommand(processCommand("process.start", "Starts a process", &SupervisedProcess::start));
    addCommand(processCommand("process.stop", "Ends a process: SIGTERM, after 5 s SIGKILL",
                              &SupervisedProcess::stop));
    addCommand(
        processCommand("process.restart", "Ends a process and starts it again", &SupervisedProcess::restart));
    addCommand(
        Command("process.output", "The last lines that a process wrote")
            .needs(Role::Observer)
            .param(Field::text("name", "Of the process"))
            .param(
                Field::integer("lines", "How many").range(1, int(SupervisedProcess::keptLines)).byDefault(50))
            .answers([this](const Call &call) -> Result<QStringList> {
                const SupervisedProcess *const process = find(call.text("name"));
                if (!process)
                    return noProcess(call.text("name"));
                return process->output(call.integer("lines"));
            }));
    addCommand(
        Command("process.add", "Adds a process to the settings; settings.save keeps it")
            .needs(Role::Engineer)
            .param(Field::text("name", "Of the process"))
            .param(Field::text("program", "Path or name (hermes-NAME)").optional())
            .param(Field::array("arguments", "Command line", {{"type", "string"}}).optional())
            .param(Field::integer("port", "Where it accepts commands (the usual one of NAME)")
                       .range(0, 65535)
                       .optional())
            .param(Field::boolean("autostart", "Starts with the supervisor").optional())
            .example({{"name", "camera"}, {"program", "/opt/robot/camera.py"}, {"port", 7480}}, QJsonValue())
            .answers([this](const Call &call) { return add(call); }));
    addCommand(Command("process.remove", "Ends a process and takes it out of the settings")
                   .with("x-destructive", "the entry of the process")
                   .needs(Role::Engineer)
                   .param(Field::text("name", "Of the process"))
                   .answers([this](const Call &call) { return remove(call.text("name")); }));
}

Command Supervisor::processCommand(const QString &name, const QString &summary,
                                   void (SupervisedProcess::*action)()) {
    return Command(name, summary)
        .param(Field::text("name", "Of the process"))
        .example({{"name", "scanmatcher"}}, QJsonValue())
        .answers([this, action](const Call &call) -> Result<void> {
            SupervisedProcess *const process = find(call.text("name"));
            if (!process)
                return noProcess(call.text("name"));
            (process->*action)();
            return {};
        });
}

Result<void> Supervisor::start() {
    guard_ = std::make_shared<ProcessGuard>();
    tellRobot();
    reconcile();
    timer_.start(std::chrono::seconds(1));
    setState(DaemonState::Running);
    return {};
}

void Supervisor::settingsChanged(const QStringList &) {
    tellRobot();
    reconcile();
}

void Supervisor::tellRobot() {
    if (!robot_)
        robot_ = ownRobot(); // it is one of several computers of a robot
    if (!robot_) {
        const Result<QString> id = robotId(settings().value("listen").toArray());
        if (!id)
            health().set("robot identity", HealthLevel::Warn,
                         "the next start is another robot: " + id.error().message);
        const QString host = QHostInfo::localHostName();
        robot_ = {id ? *id : newRobotId(), host.isEmpty() ? "robot" : host};
    }
    setOwnRobot({robot_->id, settings().text("robot")});
    if (!ownRobot()) // not named by the settings, or by nothing that can be shown
        setOwnRobot(*robot_);
}

void Supervisor::reconcile() {
    std::vector<std::unique_ptr<SupervisedProcess>> next;
    std::vector<std::pair<SupervisedProcess *, ProcessEntry>> changes; // told when the list is whole again
    std::vector<SupervisedProcess *> starts;
    for (const QJsonValue &json : settings().value("processes").toArray()) {
        const ProcessEntry entry = toEntry(json.toObject());
        const auto known = std::find_if(processes_.begin(), processes_.end(), [&](const auto &process) {
            return process && process->entry().name == entry.name;
        });
        if (known != processes_.end()) {
            next.push_back(std::move(*known));
            changes.emplace_back(next.back().get(), entry);
            continue;
        }
        next.push_back(std::make_unique<SupervisedProcess>(entry, guard_));
        connect(next.back().get(), &SupervisedProcess::changed, this, &Supervisor::update);
        if (entry.autostart)
            starts.push_back(next.back().get());
    }
    std::swap(processes_, next);
    for (const auto &[process, entry] : changes)
        process->setEntry(entry);
    for (SupervisedProcess *const process : starts)
        process->start();
    for (auto &process : next)
        if (process)
            dismiss(std::move(process));
    update();
}

void Supervisor::dismiss(std::unique_ptr<SupervisedProcess> process) {
    process->disconnect(this);
    health().remove(itemOf(*process));
    SupervisedProcess *const leaving = process.release();
    leaving->setParent(this);
    connect(leaving, &SupervisedProcess::changed, leaving, [leaving] {
        if (!leaving->isAlive())
            leaving->deleteLater();
    });
    leaving->stop();
}

SupervisedProcess *Supervisor::find(const QString &name) const {
    for (const auto &process : processes_)
        if (process->entry().name == name)
            return process.get();
    return nullptr;
}

Result<void> Supervisor::add(const Call &call) {
    QJsonArray entries = settings().value("processes").toArray();
    entries.append(call.params);
    return setEntries(entries);
}

Result<void> Supervisor::remove(const QString &name) {
    QJsonArray entries = settings().value("processes").toArray();
    for (int i = 0; i < entries.size(); ++i)
        if (entries[i].toObject()["name"].toString() == name) {
            entries.removeAt(i);
            return setEntries(entries);
        }
    return noProcess(name);
}

Result<void> Supervisor::setEntries(const QJsonArray &entries) {
    const auto done = settings().set({{"processes", entries}});
    return done ? Result<void>() : done.error();
}

ProcessesMessage Supervisor::list() {
    ProcessesMessage all{ownRobot().value_or(*robot_).name, {}};
    for (const auto &process : processes_)
        all.processes.push_back(process->status());
    return all;
}

void Supervisor::update() {
    for (const auto &process : processes_) {
        const QString item = itemOf(*process);
        const auto state = process->state();
        if (state == SupervisedProcess::State::Failed || state == SupervisedProcess::State::Waiting)
            health().set(item, HealthLevel::Failed, toString(state) + ": " + process->lastExit());
        else
            health().set(item, HealthLevel::Ok, toString(state));
    }
    if (const QString problem = setup_->problem(); problem.isEmpty())
        health().remove("settings files");
    else
        health().set("settings files", HealthLevel::Warn, problem);
    publish("processes", [this] { return list(); });
}

void Supervisor::stop() {
    timer_.stop();
    // All are told before one is waited for: the robot stands at once, whoever needs long to end.
    for (const auto &process : processes_)
        process->stop();
    processes_.clear();
}

} // namespace hermes::supervisor
