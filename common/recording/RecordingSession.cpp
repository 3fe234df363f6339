#include "common/recording/RecordingSession.h"

#include "common/OwnRobot.h"
#include "common/Time.h"
#include "common/files/NamedFile.h"
#include "common/recording/DiskError.h"
#include "common/recording/FileSync.h"
#include "common/recording/Sidecar.h"
#include "protocol/wire/Fields.h"

#include <QDateTime>
#include <QDir>
#include <QSysInfo>
#include <QUuid>

#include <fcntl.h>
#include <sys/statvfs.h>

namespace hermes {

namespace {

constexpr off_t reserveBytes = 256 * 1024; // for the last version of the sidecar, should the disk be full

/// Of this run of the kernel, of which monotonic times tell the age whatever clocks said; empty: not known.
QString bootIdentity() {
    QFile file("/proc/sys/kernel/random/boot_id");
    return file.open(QIODevice::ReadOnly) ? QString::fromLatin1(file.readAll().trimmed()) : QString();
}

QString toText(RecordingEnd end) {
    switch (end) {
    case RecordingEnd::Stopped:
        return "stopped";
    case RecordingEnd::FreeSpace:
        return "free space";
    case RecordingEnd::Failed:
        return "failed";
    case RecordingEnd::CutOff:
        return "cut off";
    }
    return {};
}

QString toUtc(double stamp) {
    return QDateTime::fromMSecsSinceEpoch(qint64(stamp * 1e3), Qt::UTC).toString(Qt::ISODateWithMs);
}

/// When a recording began that was interrupted, by the clocks of now.
Moment startOf(const QJsonObject &sidecar, const Moment &now) {
    const auto stamp_ns = qint64(sidecar["start"].toDouble() * 1e9);
    const bool isSameRun = sidecar["boot"].toString() == bootIdentity();
    return {stamp_ns, isSameRun ? qint64(sidecar["start_mono"].toDouble() * 1e9)
                                : now.mono_ns - (now.stamp_ns - stamp_ns)};
}

/// Room that stays taken until the recording ends. Not every file system can; then there is none. Error: the
/// disk is full.
Result<void> reserve(const QString &path) {
    QFile file;
    if (const Result<void> opened = openOwnFile(file, path); !opened)
        return opened;
    const int error = ::posix_fallocate(file.handle(), 0, reserveBytes);
    if (error != 0)
        file.resize(0);
    if (error != ENOSPC && error != EDQUOT)
        return {};
    return diskError(
        QString("%1: no room for the description of the recording: %2").arg(path, qt_error_string(error)),
        path);
}

} // namespace

Result<double> freeBytes(const QString &path) {
    struct statvfs space;
    if (!QFileInfo::exists(path) && QFileInfo(path).path() != path) // made when the first recording begins
        return freeBytes(QFileInfo(path).path());
    if (::statvfs(QFile::encodeName(path).constData(), &space) != 0)
        return diskError(path + ": its free space cannot be read: " + qt_error_string(), path);
    return double(space.f_bavail) * double(space.f_frsize);
}

QString RecordingSession::sidecarPath() const {
    return Sidecar::path(plan_.folder, options_.logger);
}

Result<void> RecordingSession::begin(const Options &options, const SessionName &session) {
    options_ = options;
    Result<void> result = lock_.take(options.root, options.logger);
    if (!result)
        return result;
    const Result<QString> folder =
        enterSessionFolder(options.root, session, options.logger, writer_.goesOn());
    if (!folder) {
        lock_.release();
        return folder.error();
    }
    plan_ = {*folder, options.logger, options.fileBytes, options.fileSeconds, {}, Moment::now()};
    if (const Result<QJsonObject> earlier = Sidecar::read(sidecarPath()); earlier && writer_.goesOn())
        plan_.earlier = *earlier;
    plan_.start = plan_.earlier.isEmpty() ? writer_.beganEarlier().value_or(plan_.start)
                                          : startOf(plan_.earlier, plan_.start);
    session_ =
        session.session.isEmpty() ? QUuid::createUuid().toString(QUuid::WithoutBraces) : session.session;
    const Moment start = plan_.start;
    head_ = {{"format", Sidecar::format},
             {"logger", options.logger},
             {"name", session.name},
             {"session", session_},
             {"host", QSysInfo::machineHostName()},
             {"start", start.stamp()},
             {"start_utc", toUtc(start.stamp())},
             {"start_mono", start.mono()},
             {"boot", bootIdentity()},
             {"settings", options.settings}};
    if (const auto robot = ownRobot())
        head_.insert("robot", asJson(*robot));
    const auto refused = [&](const Error &error) {
        abandon();
        return error;
    };
    const Result<double> room = freeBytes(*folder);
    if (!room)
        return refused(room.error());
    if (*room <= options.floorBytes)
        return refused(diskError(QString("%1: %2 MB are free, more than %3 MB are needed to record "
                                         "(record.free_floor_bytes)")
                                     .arg(*folder)
                                     .arg(*room * 1e-6, 0, 'f', 1)
                                     .arg(options.floorBytes * 1e-6, 0, 'f', 1),
                                 *folder));
    result = reserve(ownReserve());
    if (!result)
        return refused(result.error());
    result = writer_.begin(plan_);
    watch_.begin();
    if (result)
        result = look();
    if (result) // without a sidecar on the disk nobody could complete what the end of the power cuts off
        result = Sidecar::write(sidecarPath(), describe(), true);
    if (result)
        return {};
    writer_.end();
    if (!plan_.earlier.isEmpty()) {
        Sidecar::write(sidecarPath(), plan_.earlier, true);
        return refused(result.error());
    }
    for (const QString &file : QDir(*folder).entryList({options.logger + "-*"}, QDir::Files))
        QFile::remove(*folder + '/' + file); // of this moment: the folder had none before
    return refused(result.error());
}

void RecordingSession::abandon() {
    QFile::remove(ownReserve());
    lock_.release();
    QDir().rmdir(plan_.folder); // only when nothing else is in it
}

QJsonObject RecordingSession::describe() const {
    const RecordingState state = writer_.state();
    QJsonObject content = head_;
    content.insert("end", QJsonValue());
    content.insert("ended", QJsonValue());
    content.insert("complete", false);
    content.insert("bytes", state.bytes);
    content.insert("counts", asJson(state.counts));
    content.insert("losses", asJson(state.losses));
    content.insert("gps", state.gps);
    content.insert("files", state.files);
    return content;
}

Result<void> RecordingSession::refresh() {
    return Sidecar::write(sidecarPath(), describe(), false);
}

Result<void> RecordingSession::look() {
    return watch_.look(plan_.folder, options_.logger, writer_.state().files);
}

Result<void> RecordingSession::finish(RecordingEnd end, const std::optional<Error> &error) {
    writer_.end();
    const Result<void> synced = FileSync().run(plan_.folder, options_.logger);
    std::optional<Error> broken = writer_.state().error;
    for (const Result<void> &fine : {synced, look()})
        if (!fine && !broken)
            broken = fine.error();
    const std::optional<Error> failure = error ? error : broken;
    const Moment now = Moment::now();
    QJsonObject content = describe();
    content.insert("end", now.stamp());
    content.insert("end_utc", toUtc(now.stamp()));
    content.insert("end_mono", now.mono());
    content.insert("ended", toText(broken ? RecordingEnd::Failed : end));
    content.insert("complete", !broken);
    if (failure)
        content.insert("error", failure->message);
    const Result<void> written = Sidecar::write(sidecarPath(), content, true, ownReserve());
    lock_.release();
    return failure ? Result<void>(*failure) : written;
}

RecordingSession::Completed RecordingSession::completeAll(const Options &options, RecordingWriter &writer) {
    Completed completed;
    FolderLock lock;
    const QDir root(options.root);
    if (!root.exists())
        return completed;
    if (const Result<void> taken = lock.take(options.root, options.logger); !taken) {
        completed.failed << taken.error().message;
        return completed;
    }
    for (const QFileInfo &entry :
         root.entryInfoList(QDir::Dirs | QDir::NoSymLinks | QDir::NoDotAndDotDot, QDir::Name)) {
        const QString folder = entry.absoluteFilePath();
        const QString path = Sidecar::path(folder, options.logger);
        if (!QFile::exists(path))
            continue;
        const Result<QJsonObject> read = Sidecar::read(path);
        if (read && !read->value("ended").isNull())
            continue;
        QJsonObject content = read ? *read : QJsonObject();
        Result<void> result = read ? Result<void>() : read.error();
        if (result) {
            QFile::remove(reservePath(folder, options.logger));
            content.insert("end", content.value("start")); // until the writer knows better
            result = writer.repair({folder, options.logger, 0, 0}, content);
        }
        content.insert("end_utc", toUtc(content.value("end").toDouble()));
        content.insert("ended", toText(RecordingEnd::CutOff));
        if (result)
            result = Sidecar::write(path, content, true);
        if (result)
            completed.done << QString(
                                  "\"%1\" was cut off at %2, before it was stopped; what is written until "
                                  "then is whole (%3)")
                                  .arg(content.value("name").toString(entry.fileName()),
                                       content.value("end_utc").toString(), folder);
        else
            completed.failed << result.error().message;
    }
    return completed;
}

} // namespace hermes
