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
    case RecordingEnd::ShutDown:
        return "shut down";
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

/// The wall clock as the sidecar was renewed last, however often it was set before.
double seen(const QJsonObject &sidecar) {
    return sidecar["seen"].toDouble(sidecar["end"].toDouble()); // an older version tells the end alone
}

/// Goes on with a recording that was interrupted. After a restart of the system the wall clock tells how long
/// that took; where it is behind, as without a battery of its own, no time has passed.
void resume(RecordingPlan &plan) {
    const auto stamp_ns = qint64(plan.earlier.value("start").toDouble() * 1e9);
    const auto mono_ns = qint64(plan.earlier.value("start_mono").toDouble() * 1e9);
    const bool isSameRun = plan.earlier.value("boot").toString() == bootIdentity();
    const Moment now = plan.start;
    const double since_s = Sidecar::duration(plan.earlier) + std::max(0.0, now.stamp() - seen(plan.earlier));
    const qint64 since_ns = isSameRun ? now.mono_ns - mono_ns : qint64(since_s * 1e9);
    plan.start = {stamp_ns, now.mono_ns - since_ns};
    plan.toItsClock_ns = mono_ns - plan.start.mono_ns;
}

/// When a recording was cut off, by the clock that never jumps. The sidecar knows when it was renewed last;
/// what its files hold after that counts, unless the wall clock was set.
double endOf(const QJsonObject &sidecar) {
    constexpr double period_s = 5; // in which it is renewed, however busy the disk is
    const double renewed = sidecar["end_mono"].toDouble();
    const double last =
        sidecar["start_mono"].toDouble() + sidecar["end"].toDouble() - sidecar["start"].toDouble();
    return last > renewed && last < renewed + period_s ? last : renewed;
}

/// How long ago a recording ended: by the clock that never jumps where the system has run since, else by the
/// wall clock, which may also be behind.
double secondsSince(const QJsonObject &sidecar) {
    if (sidecar["boot"].toString() == bootIdentity() && sidecar["end_mono"].isDouble())
        return monotonicNow() - sidecar["end_mono"].toDouble();
    return std::abs(stampNow() - seen(sidecar));
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
    if (plan_.earlier.isEmpty())
        plan_.start = writer_.beganEarlier().value_or(plan_.start);
    else
        resume(plan_);
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
             {"start_mono", itsMono(start)},
             {"boot", plan_.earlier.value("boot").toString(bootIdentity())},
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
    const auto files = [&] { return QDir(*folder).entryList({options.logger + "-*"}, QDir::Files); };
    const QStringList before = files();
    if (!plan_.earlier.isEmpty()) { // should the power be cut now, the next start looks at all files
        QJsonObject open = plan_.earlier;
        open.insert("ended", QJsonValue());
        result = Sidecar::write(sidecarPath(), open, true);
    }
    if (result)
        result = writer_.begin(plan_);
    watch_.begin();
    if (result)
        result = look();
    if (result) // without a sidecar on the disk nobody could complete what the end of the power cuts off
        result = Sidecar::write(sidecarPath(), describe(), true);
    if (result)
        return {};
    writer_.end();
    for (const QString &file : files())
        if (!before.contains(file)) // it is of this moment
            QFile::remove(*folder + '/' + file);
    if (!plan_.earlier.isEmpty())
        Sidecar::write(sidecarPath(), plan_.earlier, true);
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
    content.insert("seen", stampNow());
    content.insert("end_mono", itsMono(Moment::now())); // when it was renewed
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
    content.insert("end_mono", itsMono(now));
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
        const auto keepLatest = [&completed](const QJsonObject &sidecar) {
            const double since_s = secondsSince(sidecar);
            const bool isLatest = completed.latest.isEmpty() || since_s < completed.since_s;
            if (isLatest &&
                sidecar["host"].toString() == QSysInfo::machineHostName()) { // no copy from elsewhere
                completed.latest = sidecar;
                completed.since_s = since_s;
            }
        };
        if (read && !read->value("ended").isNull()) {
            keepLatest(*read);
            continue;
        }
        QJsonObject content = read ? *read : QJsonObject();
        Result<void> result = read ? Result<void>() : read.error();
        if (result) {
            QFile::remove(reservePath(folder, options.logger));
            content.insert("end", content.value("start")); // until the writer knows better
            result = writer.repair({folder, options.logger, 0, 0}, content);
        }
        content.insert("end_utc", toUtc(content.value("end").toDouble()));
        if (content.value("end_mono").isDouble()) // else an older version has written it
            content.insert("end_mono", endOf(content));
        content.insert("ended", toText(RecordingEnd::CutOff));
        if (result)
            result = Sidecar::write(path, content, true);
        if (!result) {
            completed.failed << result.error().message;
            continue;
        }
        completed.done << QString("\"%1\" was cut off at %2, before it was stopped; what is written until "
                                  "then is whole (%3)")
                              .arg(content.value("name").toString(entry.fileName()),
                                   content.value("end_utc").toString(), folder);
        keepLatest(content);
    }
    return completed;
}

} // namespace hermes
