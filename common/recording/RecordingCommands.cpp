// What every logger offers and tells of its recordings: settings, commands, status, health.
#include "common/recording/Recording.h"

#include "common/recording/Sidecar.h"

#include <QDir>

namespace hermes {

namespace {

Field byteField(const char *name, const char *description, double least, double value) {
    return Field::integer(name, description)
        .unit("byte")
        .range(least, 1e15)
        .byDefault(value)
        .group("Recording");
}

/// The names of those that have a sidecar in the folder of a session.
QJsonArray loggersIn(const QString &folder) {
    QJsonArray loggers;
    for (const QFileInfo &file : QDir(folder).entryInfoList({"*.json"}, QDir::Files, QDir::Name))
        if (const Result<QJsonObject> sidecar = Sidecar::read(file.absoluteFilePath()))
            loggers.append(sidecar->value("logger"));
    return loggers;
}

} // namespace

std::vector<Field> Recording::settingFields() {
    return {Field::text("record.folder", "Where recordings are kept, a folder each; made when missing")
                .byDefault("recordings")
                .appliesOnRestart()
                .group("Recording"),
            byteField("record.free_floor_bytes", "Free space of the disk at which a recording is ended", 0,
                      268435456),
            byteField("record.free_warn_bytes",
                      "Free space of the disk below which health is at error while recording", 0,
                      2147483648.0)};
}

std::vector<Field> Recording::rotationFields() {
    return {byteField("record.file_bytes",
                      "A recording goes on in a new file before one gets longer than this", 65536, 1e9),
            Field::number("record.file_s", "A recording goes on in a new file after this time")
                .unit("s")
                .range(1, 1e9)
                .byDefault(3600)
                .group("Recording")};
}

std::vector<SchemaViolation> Recording::checkSettings(const QJsonObject &settings) {
    const QJsonObject record = settings.value("record").toObject();
    const QJsonValue warn = record.value("free_warn_bytes");
    if (warn.toDouble() >= record.value("free_floor_bytes").toDouble())
        return {};
    return {{"record.free_warn_bytes", warn, "at least record.free_floor_bytes"}};
}

std::vector<Command> Recording::commands() {
    const QJsonObject example{{"recording", true}, {"name", "drive"}, {"folder", "/data/drive"}};
    return {
        Command("record.start", "Records all that comes in to a new folder NAME in the folder of recordings")
            .param(Field::text("name", "Of the recording: of its folder, without a path"))
            .param(Field::text("session",
                               "Id that loggers give alike which record to the same folder as one session; "
                               "without it the folder must be new")
                       .optional())
            .returns({{"type", "object"}})
            .example({{"name", "drive"}}, example)
            .asyncHandler([this](const Call &call, const Reply &reply) { start(call, reply); }),
        Command("record.stop", "Ends the recording; everything is on the disk when this returns")
            .returns({{"type", "object"}})
            .asyncHandler([this](const Call &, const Reply &reply) { stop(reply); }),
        Command("record.status",
                "Of the recording under way or the last: name, session, folder, path, bytes, files, "
                "counts, losses, free_bytes of the disk, and the error that ended it")
            .returns({{"type", "object"}})
            .handler([this](const Call &) -> Result<QJsonValue> { return status(); }),
        Command("record.list",
                "The recordings in the folder, the latest first: name, folder, loggers (those of its session "
                "in the same folder), and of its sidecar session, start, end, ended, complete, files (how "
                "many), bytes, counts, losses; or the error of one that cannot be read")
            .returns({{"type", "array"}})
            .asyncHandler([this](const Call &, const Reply &reply) { list(reply); })};
}

void Recording::list(const Reply &reply) {
    run([reply, root = options().root, logger = logger_]() -> Done {
        std::vector<QJsonObject> found;
        for (const QString &name : QDir(root).entryList(QDir::Dirs | QDir::NoDotAndDotDot, QDir::Name)) {
            const QString path = Sidecar::path(QDir(root).filePath(name), logger);
            if (!QFile::exists(path))
                continue;
            const Result<QJsonObject> sidecar = Sidecar::read(path);
            QJsonObject entry{{"name", name}};
            for (const char *member :
                 {"session", "start", "end", "ended", "complete", "bytes", "counts", "losses"})
                if (sidecar)
                    entry.insert(member, sidecar->value(member));
            if (sidecar) {
                const QString folder = QDir(root).absoluteFilePath(name);
                entry.insert("folder", folder);
                entry.insert("files", sidecar->value("files").toArray().size());
                entry.insert("loggers", loggersIn(folder));
            }
            if (!sidecar)
                entry.insert("error", sidecar.error().message);
            found.push_back(entry);
        }
        std::stable_sort(found.begin(), found.end(), [](const QJsonObject &a, const QJsonObject &b) {
            return a.value("start").toDouble() > b.value("start").toDouble();
        });
        QJsonArray recordings;
        for (const QJsonObject &entry : found)
            recordings.append(entry);
        return [reply, recordings] { reply.result(recordings); };
    });
}

QJsonObject Recording::status() const {
    QJsonObject status{{"recording", phase_ == Phase::Recording}};
    if (free_)
        status.insert("free_bytes", *free_);
    if (error_)
        status.insert(
            "error",
            QJsonObject{{"code", error_->code}, {"message", error_->message}, {"data", error_->data}});
    if (folder_.isEmpty())
        return status;
    const RecordingState state = writer_.state();
    status.insert("name", name_.name);
    status.insert("session", name_.session);
    status.insert("folder", folder_);
    status.insert("path", state.path);
    status.insert("start", start_);
    status.insert("bytes", state.bytes);
    status.insert("files", state.files.size());
    status.insert("counts", state.counts);
    status.insert("losses", state.losses);
    return status;
}

void Recording::updateHealth() {
    updateDiskHealth();
    const QJsonObject values = status();
    double lost = 0;
    const QJsonObject losses = values.value("losses").toObject();
    for (const QJsonValue &count : losses)
        lost += count.toDouble();
    if (error_)
        health_.set("recording", HealthLevel::Failed, error_->message, values);
    else if (refreshError_)
        health_.set("recording", HealthLevel::Warn, refreshError_->message, values);
    else if (!unrepaired_.isEmpty())
        health_.set("recording", HealthLevel::Warn, unrepaired_.join("; "), values);
    else if (lost > 0)
        health_.set("recording", HealthLevel::Warn,
                    folder_ + ": not all that was to be recorded is there, see losses", values);
    else
        health_.set("recording", HealthLevel::Ok,
                    phase_ == Phase::Recording ? "recording to " + folder_ : QString("not recording"),
                    values);
}

void Recording::updateDiskHealth() {
    const double warn = settings_.number("record.free_warn_bytes");
    const QString root = options().root;
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
