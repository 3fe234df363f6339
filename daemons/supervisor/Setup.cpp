#include "daemons/supervisor/Setup.h"

#include "common/Project.h"
#include "common/settings/DottedPath.h"
#include "common/settings/SettingsTable.h"
#include "daemons/supervisor/SettingsCheck.h"
#include "daemons/supervisor/SetupProposal.h"
#include "protocol/velodyne/SensorModel.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"

#include <QCoreApplication>
#include <QDir>
#include <QFileInfo>
#include <QMap>
#include <algorithm>

namespace hermes::supervisor {
namespace {

/// Settings of any daemon that a sample does not know: how it is reached, by whom, and how much it tells.
const QStringList kept{"listen", "insecure", "access", "audit", "limits", "log", "setup"};

/// The settings of a sample with what is kept of those of now.
QJsonObject withKept(QJsonObject sample, const QJsonObject &now) {
    for (const QString &daemon : sample.keys()) {
        QJsonObject settings = sample[daemon].toObject();
        for (const QString &name : kept)
            if (now[daemon].toObject().contains(name) && !settings.contains(name))
                settings[name] = now[daemon].toObject()[name];
        sample[daemon] = settings;
    }
    return sample;
}

QString asText(const QJsonValue &value) {
    return value.isUndefined() ? QString() : QString::fromUtf8(compactJson(value));
}

/// Of the daemons in next.
std::vector<SettingChange> changesBetween(const QJsonObject &now, const QJsonObject &next) {
    std::vector<SettingChange> changes;
    for (const QString &daemon : next.keys()) {
        const QJsonObject before = now[daemon].toObject(), after = next[daemon].toObject();
        QStringList paths = leafPaths(before) + leafPaths(after);
        paths.sort();
        paths.removeDuplicates();
        for (const QString &path : qAsConst(paths))
            if (const QJsonValue old = valueAt(before, path), value = valueAt(after, path);
                old != value && !(old.isObject() && value.isObject()))
                changes.push_back({daemon, path, asText(old), asText(value)});
    }
    return changes;
}

/// Where an installation has them, below the same prefix as this program.
QString installedSamples() {
    const QString found =
        QDir(QCoreApplication::applicationDirPath() + "/../share/hermes/settings").canonicalPath();
    return found.isEmpty() ? "/usr/share/hermes/settings" : found;
}

Field sampleField() {
    return Field::text("sample", "Settings of a whole robot to begin with, by name; empty: those of now")
        .byDefault("");
}

} // namespace

Setup::Setup(Settings &settings, Processes processes, QObject *parent)
    : QObject(parent)
    , settings_(settings)
    , processes_(std::move(processes)) {
    SettingsTable table;
    table.group("Setup");
    table.define("setup.folder", "/etc/hermes", "Of the settings files of the daemons, NAME.json");
    table.define("setup.samples", installedSamples(), "Of folders with settings of whole robots");
    table.defineList("setup.ports", "Serial lines to search beside those that the system lists",
                     {{"type", "string"}});
    table.define("setup.lidar_port", velodyne::dataPort, "UDP port at which lidars are looked for")
        .range(1, 65535);
    table.define("setup.position_port", velodyne::positionPort, "The same for their position packets")
        .range(1, 65535);
    table.declareIn(settings);
}

std::vector<Command> Setup::commands() {
    return {findCommand(), proposeCommand(), applyCommand(), undoCommand(),
            Command("setup.samples", "The settings of whole robots that there are")
                .needs(Role::Observer)
                .answers([this](const Call &) { return files().sampleNames(); })};
}

SettingsFiles Setup::files() const {
    return {settings_.text("setup.folder"), settings_.text("setup.samples")};
}

Error Setup::busy(const char *what) {
    return Error(ErrorCode::NotReady, QString("%1 is under way; try again when it has ended").arg(what));
}

Command Setup::proposeCommand() {
    return Command("setup.propose",
                   "What the settings should be with what the last setup.find has found; changes nothing")
        .needs(Role::Engineer)
        .param(sampleField())
        .answers([this](const Call &call) -> Result<Proposal> {
            if (!found_ && call.text("sample").isEmpty())
                return Error(ErrorCode::NotReady, "nothing was looked for yet; setup.find does");
            return proposal(call.text("sample"));
        });
}

Result<Proposal> Setup::proposal(const QString &sample) const {
    const auto base = sample.isEmpty() ? files().current() : files().sample(sample);
    if (!base)
        return base.error();
    Proposal proposal = found_ ? propose(*found_, *base, settings_.text("setup.folder")) : Proposal();
    if (sample.isEmpty() && proposal.settings.isEmpty())
        return proposal;
    const auto next = whole(sample, proposal.settings);
    if (!next)
        return next.error();
    proposal.changes = changesBetween(files().readable(), *next);
    return proposal;
}

Result<QJsonObject> Setup::whole(const QString &sample, const QJsonObject &changes) const {
    const auto base = sample.isEmpty() ? files().current() : files().sample(sample);
    if (!base)
        return base.error();
    QJsonObject whole = sample.isEmpty() ? QJsonObject() : withKept(*base, files().readable());
    for (const QString &daemon : changes.keys()) {
        if (!daemonNames().contains(daemon) || !changes[daemon].isObject())
            return Error(ErrorCode::InvalidParams,
                         QString("settings.%1: expected an object of settings of one of: %2")
                             .arg(daemon, daemonNames().join(", ")));
        const QJsonObject before = (sample.isEmpty() ? *base : whole)[daemon].toObject();
        whole[daemon] = merged(before, changes[daemon].toObject());
    }
    if (whole.isEmpty())
        return Error(ErrorCode::InvalidParams, "a sample or settings are expected");
    for (const QString &daemon : filesOf(valueAt(whole, "supervisor.processes").toArray()))
        if (!whole.contains(daemon) && !QFileInfo::exists(files().path(daemon)))
            whole.insert(daemon, QJsonObject());
    return whole;
}

QStringList Setup::filesOf(const QJsonArray &processes) const {
    QStringList daemons;
    for (const QString &daemon : daemonNames())
        if (std::any_of(processes.begin(), processes.end(), [&](const QJsonValue &process) {
                return process["arguments"].toArray().contains(files().path(daemon));
            }))
            daemons.append(daemon);
    return daemons;
}

Command Setup::applyCommand() {
    return Command(
               "setup.apply",
               "Writes the settings files of a sample, or those of now, with these changes, when all daemons "
               "would take theirs; else nothing. What was there stays beside, see setup.undo. Processes "
               "whose settings were written are started anew if they run or start with the supervisor")
        .needs(Role::Engineer)
        .param(sampleField())
        .param(Field::object("settings", "By daemons: what changes in the settings of each")
                   .byDefault(QJsonObject()))
        .gives<Applied>()
        .example({{"sample", "simulator"}}, QJsonObject{{"files", QJsonArray{"/etc/hermes/simulator.json"}},
                                                        {"restarted", QJsonArray{"simulator"}}})
        .asyncHandler([this](const Call &call, const Reply &reply) {
            if (isWriting_ || isSearching_)
                return reply.error(busy(isWriting_ ? "another change" : "a search"));
            const QString sample = call.text("sample");
            const QJsonObject changes = call.value("settings").toObject();
            const auto settings = whole(sample, changes);
            if (!settings)
                return reply.error(settings.error());
            isWriting_ = true;
            new SettingsCheck(
                *settings,
                [=, settings = *settings](const Result<void> &checked) {
                    isWriting_ = false;
                    const auto written = checked ? write(sample, changes, settings) : checked.error();
                    written ? reply.result(asJson(*written)) : reply.error(written.error());
                },
                this);
        });
}

Result<Applied> Setup::write(const QString &sample, const QJsonObject &changes, const QJsonObject &checked) {
    const auto meant = whole(sample, changes);
    if (!meant || *meant != checked)
        return Error(ErrorCode::NotReady,
                     "the settings files were changed by somebody else meanwhile; nothing was changed");
    const QStringList lost = sample.isEmpty() ? QStringList() : files().unreadable(checked.keys());
    const QJsonObject there = files().readable();
    QJsonObject fresh = checked;
    for (const QString &daemon : checked.keys())
        if (there.contains(daemon) && there[daemon] == checked[daemon])
            fresh.remove(daemon);
    if (fresh.isEmpty())
        return Applied{{}, {}, {"all settings are so already; nothing was written"}};
    const auto written = files().write(fresh);
    if (!written)
        return written.error();
    return take(*written, lost);
}

Command Setup::undoCommand() {
    return Command("setup.undo", "Puts the settings files back that the last setup.apply has replaced, "
                                 "whatever was changed in them since, and starts their processes anew. What "
                                 "it replaces stays beside, as NAME.json.undone")
        .needs(Role::Engineer)
        .answers([this](const Call &) -> Result<Applied> {
            if (isWriting_ || isSearching_)
                return busy(isWriting_ ? "another change" : "a search");
            const auto written = files().undo();
            if (!written)
                return written.error();
            return take(*written, {});
        });
}

Result<Applied> Setup::take(const QStringList &written, const QStringList &notes) {
    struct Before {
        bool autostart, ran;
        int orders;
    };
    QMap<QString, Before> before;
    for (const SupervisedProcess *const process : processes_())
        before.insert(process->entry().name,
                      {process->entry().autostart, process->isAlive(), process->orders()});
    const SettingsFiles these = files(); // what is loaded may name others
    const QString own = these.path("supervisor");
    const auto loaded = written.contains(own) ? settings_.load(own) : Result<void>();
    Applied applied{written, {}, notes};
    for (SupervisedProcess *const process : processes_()) {
        const ProcessEntry &entry = process->entry();
        const auto old = before.constFind(entry.name);
        const bool isNew = old == before.constEnd();
        const bool startsNow = entry.autostart && (isNew || !old->autostart);
        const bool isStarted = !isNew && old->orders != process->orders(); // by its new entry
        const bool isWritten = written.contains(these.path(entry.name));
        if (!isStarted && (process->isAlive() ? !isWritten : !(entry.autostart && (isWritten || startsNow))))
            continue;
        if (!isStarted)
            !isNew && old->ran ? process->restart() : process->start();
        applied.restarted.append(entry.name);
    }
    for (const SupervisedProcess *const process : processes_())
        before.remove(process->entry().name);
    for (const QString &name : before.keys())
        applied.notes.append(name +
                             " is no process of the supervisor any more, and ends; setup.undo puts it back");
    if (!loaded)
        return Error(ErrorCode::InvalidSetting,
                     loaded.error().message +
                         "; the files are written, and the supervisor goes on with the settings that it had");
    return applied;
}

} // namespace hermes::supervisor
