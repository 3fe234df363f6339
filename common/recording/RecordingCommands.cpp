// What every logger offers and tells of its recordings: settings, commands, status, health.
#include "common/recording/Recording.h"

#include "common/Time.h"
#include "common/recording/Sidecar.h"
#include "common/settings/SettingsTable.h"
#include "protocol/wire/Fields.h"

#include <QDir>

namespace hermes {

namespace {

/// There is a folder, and the free space to warn at lies above that to stop at.
std::vector<SchemaViolation> checkRoom(const QJsonObject &settings) {
    const QJsonObject record = settings.value("record").toObject();
    if (const QJsonValue folder = record.value("folder"); folder.toString().isEmpty())
        return {{"record.folder", folder, "the name of a folder"}};
    const QJsonValue warn = record.value("free_warn_bytes");
    if (warn.toDouble() >= record.value("free_floor_bytes").toDouble())
        return {};
    return {{"record.free_warn_bytes", warn, "at least record.free_floor_bytes"}};
}

} // namespace

void Recording::declareSettings(Files files) {
    SettingsTable table;
    table.group("Recording", SettingsTable::Applies::OnRestart);
    table.define("record.folder", "recordings",
                 "Where recordings are kept, a folder each; made when missing");
    table.group("Recording");
    table.define("record.free_floor_bytes", 268435456, "Free space of the disk at which a recording is ended",
                 "byte", 0, 1e15);
    table.define("record.free_warn_bytes", std::int64_t(1) << 31,
                 "Free space of the disk below which health is at error while recording", "byte", 0, 1e15);
    if (files == Files::Several) {
        table.define("record.file_bytes", 1000000000,
                     "Largest size of a file of a recording; then it goes on in a new one", "byte", 65536,
                     1e15);
        table.define("record.file_s", 3600.0,
                     "Longest time of a file of a recording; then it goes on in a new one", "s", 1, 1e9);
    }
    table.declareIn(settings_);
    settings_.addRule(checkRoom);
}

std::vector<Command> Recording::commands() {
    const QJsonObject example{{"recording", true}, {"name", "drive"}, {"folder", "/data/drive"}};
    return {
        Command("record.start", "Records all that comes in to a new folder NAME in the folder of recordings")
            .param(Field::text("name", "Of the recording: of its folder, without a path"))
            .param(Field::text("session", "Id of the session: loggers with the same one record to the same "
                                          "folder; without it the folder must be new")
                       .optional())
            .gives<RecordingStatus>()
            .example({{"name", "drive"}}, example)
            .asyncHandler([this](const Call &call, const Reply &reply) { start(call, reply); }),
        Command("record.stop", "Ends the recording; everything is on the disk when this returns")
            .param(Field::text("session", "Ends only this session; one that others have begun since goes on")
                       .optional())
            .gives<RecordingStatus>()
            .asyncHandler([this](const Call &call, const Reply &reply) { stop(call, reply); }),
        Command("record.status", "The recording under way or the last")
            .needs(Role::Observer)
            .answers([this](const Call &) { return status(); }),
        Command("record.list", "The recordings in the folder, the latest first")
            .needs(Role::Observer)
            .gives<std::vector<RecordingEntry>>()
            .asyncHandler([this](const Call &, const Reply &reply) { list(reply); })};
}

void Recording::list(const Reply &reply) {
    run(disk_, [reply, root = options().root, logger = logger_]() -> Done {
        std::vector<RecordingEntry> found;
        for (const QFileInfo &folder :
             QDir(root).entryInfoList(QDir::Dirs | QDir::NoDotAndDotDot, QDir::Name))
            if (const QString path = Sidecar::path(folder.absoluteFilePath(), logger); QFile::exists(path))
                found.push_back(Sidecar::entry(path, Sidecar::read(path)));
        std::stable_sort(found.begin(), found.end(), [](const RecordingEntry &a, const RecordingEntry &b) {
            return a.start.value_or(0) > b.start.value_or(0);
        });
        return [reply, found] { reply.result(asJson(found)); };
    });
}

RecordingStatus Recording::status() const {
    RecordingStatus status;
    status.recording = phase_ == Phase::Recording;
    status.freeBytes = free_;
    if (error_) {
        status.error = RecordingError{error_->code, error_->message, {}};
        if (!error_->data.isUndefined())
            status.error->data = error_->data;
    }
    if (folder_.isEmpty())
        return status;
    const RecordingState state = writer_.state();
    status.name = name_.name;
    status.session = name_.session;
    status.folder = folder_;
    status.path = state.path;
    status.start = start_.stamp();
    status.duration_s =
        std::max(0.0, (phase_ == Phase::Recording ? monotonicNow() : endMono_) - start_.mono());
    status.bytes = state.bytes;
    status.files = state.files.size();
    status.counts = state.counts;
    status.losses = state.losses;
    return status;
}

void Recording::updateHealth() {
    updateDiskHealth();
    const RecordingStatus now = status();
    const QJsonObject values = asJson(now).toObject();
    double lost = 0;
    for (const double count : now.losses.value_or(NamedCounts()))
        lost += count;
    const HealthLevel past = losses_.level(lost);
    if (error_)
        health_.set("recording", HealthLevel::Failed, error_->message, values);
    else if (refreshError_)
        health_.set("recording", HealthLevel::Warn, refreshError_->message, values);
    else if (!unrepaired_.isEmpty() || !cutOff_.isEmpty())
        health_.set("recording", HealthLevel::Warn, (unrepaired_ + cutOff_).join("; "), values);
    else if (lost > 0)
        health_.set("recording", phase_ == Phase::Idle ? past : HealthLevel::Warn,
                    folder_ + ": not all that was to be recorded is there, see losses", values);
    else
        health_.set("recording", HealthLevel::Ok,
                    phase_ == Phase::Recording ? "recording to " + folder_ : QString("not recording"),
                    values);
}

void Recording::updateDiskHealth() {
    const double warn = settings_.number("record.free_warn_bytes");
    const QString root = options().root;
    if (!isChecked_) {
        health_.set("disk", HealthLevel::Ok, root + ": its free space is being read");
        return;
    }
    if (!free_) {
        health_.set("disk", HealthLevel::Warn, root + ": its free space is not known");
        return;
    }
    const bool low = *free_ < warn;
    const QString message = QString("%1 MB are free below %2").arg(*free_ * 1e-6, 0, 'f', 1).arg(root);
    const HealthLevel bad = phase_ == Phase::Idle ? HealthLevel::Warn : HealthLevel::Failed;
    health_.set("disk", low ? bad : HealthLevel::Ok,
                low ? message + QString("; a recording is ended at %1 MB")
                                    .arg(settings_.number("record.free_floor_bytes") * 1e-6, 0, 'f', 1)
                    : message,
                QJsonObject{{"free_bytes", *free_}});
}

} // namespace hermes
