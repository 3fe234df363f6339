#include "common/recording/Recording.h"

#include "common/Log.h"
#include "common/Time.h"
#include "common/recording/DiskError.h"
#include "protocol/wire/Fields.h"

#include <QDir>

namespace hermes {

namespace {

constexpr int activePeriod_ms = 200; // at 25 MB/s the disk fills by 5 MB meanwhile
constexpr int idlePeriod_ms = 5000;
constexpr int refreshEvery = 5;    // checks: the sidecar is at most a second old
constexpr int syncPeriod_ms = 700; // until the next check, and the disk's time: less than a second

Error nothingRecorded() {
    return Error(ErrorCode::NotReady, "nothing is being recorded; record.start begins");
}

} // namespace

Recording::Recording(const QString &logger, Settings &settings, Health &health, RecordingWriter &writer,
                     Files files)
    : logger_(logger)
    , settings_(settings)
    , health_(health)
    , writer_(writer)
    , session_(writer) {
    disk_.setMaxThreadCount(1);
    syncs_.setMaxThreadCount(1);
    connect(&timer_, &QTimer::timeout, this, &Recording::check);
    declareSettings(files);
}

Recording::~Recording() {
    close();
}

RecordingSession::Options Recording::options() const {
    RecordingSession::Options options;
    options.logger = logger_;
    options.root = QDir(settings_.text("record.folder")).absolutePath();
    options.fileBytes = settings_.number("record.file_bytes");
    options.fileSeconds = settings_.number("record.file_s");
    options.floorBytes = settings_.number("record.free_floor_bytes");
    options.settings = settings_.inForce();
    return options;
}

void Recording::run(QThreadPool &pool, std::function<Done()> job) {
    pool.start(QRunnable::create([this, job = std::move(job)] {
        const Done done = job();
        const auto unlessClosed = [this, done] {
            if (!closed_)
                done();
        };
        QMetaObject::invokeMethod(this, unlessClosed, Qt::QueuedConnection);
    }));
}

void Recording::open() {
    closed_ = checking_ = syncing_ = false;
    timer_.start(idlePeriod_ms);
    run(disk_, [this, options = options()]() -> Done {
        const RecordingSession::Completed completed = RecordingSession::completeAll(options, writer_);
        return [this, completed] {
            for (const QString &line : completed.done)
                logWarning("recording", line);
            for (const QString &line : completed.failed)
                logError("recording", line);
            unrepaired_ = completed.failed;
            if (phase_ == Phase::Idle) // else one was begun meanwhile
                cutOff_ = completed.done;
            updateHealth();
            Q_EMIT this->completed(completed.latest, completed.since_s);
        };
    });
    check();
    updateHealth();
}

void Recording::close() {
    if (closed_)
        return;
    closed_ = true;
    timer_.stop();
    disk_.clear();
    disk_.waitForDone();
    syncs_.waitForDone();
    if (session_.isOpen()) {
        const bool isEnding = phase_ == Phase::Ending; // its job was dropped above
        const RecordingEnd unasked = stopping_.empty() ? RecordingEnd::ShutDown : RecordingEnd::Stopped;
        const Result<void> result =
            session_.finish(isEnding ? endReason_ : unasked, isEnding ? error_ : std::nullopt);
        if (!result)
            logError("recording", result.error().message);
    }
    phase_ = Phase::Idle;
    giveToStopping(Error(ErrorCode::NotReady, "the logger ends, and the recording with it"));
}

void Recording::start(const Call &call, const Reply &reply) {
    const SessionName name{call.text("name"), call.has("session") ? call.text("session") : QString()};
    Result<void> fine = checkName("name", name.name);
    if (fine && call.has("session"))
        fine = checkName("session", name.session);
    if (fine && phase_ != Phase::Idle)
        fine = Error(ErrorCode::NotReady,
                     phase_ == Phase::Starting
                         ? QString("another recording is about to begin; record.stop ends it")
                         : QString("\"%1\" is being recorded; record.stop ends it").arg(name_.name));
    if (fine && condition_)
        fine = condition_();
    if (!fine)
        return reply.error(fine.error());
    phase_ = Phase::Starting;
    beginning_ = name.session;
    run(disk_, [this, name, reply, options = options()]() -> Done {
        const Result<void> begun = session_.begin(options, name);
        return [this, name, reply, begun] {
            phase_ = begun ? Phase::Recording : Phase::Idle;
            if (!begun) {
                giveToStopping(nothingRecorded());
                return reply.error(begun.error());
            }
            name_ = {name.name, session_.session()};
            folder_ = session_.folder();
            start_ = session_.start();
            error_.reset();
            refreshError_.reset();
            cutOff_.clear();
            timer_.start(activePeriod_ms);
            logInfo("recording", "recording to " + folder_);
            updateHealth();
            reply.result(asJson(status()));
            if (!stopping_.empty()) // whoever began it did not wait
                end(RecordingEnd::Stopped, {});
            Q_EMIT changed();
        };
    });
}

void Recording::stop(const Call &call, const Reply &reply) {
    const QString session = phase_ == Phase::Starting ? beginning_ : name_.session;
    if (call.has("session") && (session.isEmpty() || call.text("session") != session))
        return reply.error(
            Error(ErrorCode::NotReady, "no such session is being recorded: " + call.text("session")));
    if (phase_ == Phase::Idle)
        return reply.error(error_ ? *error_ : nothingRecorded());
    stopping_.push_back(reply);
    if (phase_ == Phase::Recording)
        end(RecordingEnd::Stopped, {});
}

void Recording::giveToStopping(const Result<QJsonValue> &result) {
    for (const Reply &reply : std::exchange(stopping_, {}))
        reply.give(result);
}

void Recording::end(RecordingEnd reason, const std::optional<Error> &error) {
    phase_ = Phase::Ending;
    endReason_ = reason;
    endMono_ = monotonicNow();
    error_ = error; // told at once, not when the disk is done
    run(disk_, [this, reason, error]() -> Done {
        const Result<void> result = session_.finish(reason, error);
        return [this, result] { ended(result); };
    });
}

void Recording::ended(const Result<void> &result) {
    phase_ = Phase::Idle;
    timer_.start(idlePeriod_ms);
    if (result) {
        error_.reset();
        logInfo("recording", folder_ + ": the recording is complete");
    } else {
        error_ = result.error();
        logError("recording", error_->message);
    }
    giveToStopping(result ? Result<QJsonValue>(asJson(status())) : Result<QJsonValue>(result.error()));
    updateHealth();
    Q_EMIT changed();
}

/// Beside writing, and beside the checks of the free space: a disk may take long over it.
void Recording::sync() {
    if (syncing_ || phase_ != Phase::Recording ||
        (sinceSync_.isValid() && sinceSync_.elapsed() < syncPeriod_ms))
        return;
    syncing_ = true;
    sinceSync_.start();
    run(syncs_, [this, folder = folder_]() -> Done {
        const Result<void> synced = sync_.run(folder, logger_);
        return [this, folder, synced] {
            syncing_ = false;
            if (!synced && phase_ == Phase::Recording && folder == folder_)
                end(RecordingEnd::Failed, synced.error());
        };
    });
}

void Recording::check() {
    sync();
    if (checking_ || phase_ == Phase::Starting || phase_ == Phase::Ending)
        return;
    checking_ = true;
    const bool active = phase_ == Phase::Recording;
    const bool refresh = active && ++checks_ % refreshEvery == 0;
    run(disk_, [this, refresh, active, path = active ? folder_ : options().root]() -> Done {
        const bool gone = active && !QDir(path).exists();
        Result<void> there, refreshed;
        if (gone)
            there = diskError(path + ": the folder of the recording was removed or moved away", path);
        else if (refresh && session_.isOpen())
            there = session_.look();
        if (there && refresh && session_.isOpen())
            refreshed = session_.refresh();
        const Result<double> room = freeBytes(path);
        return [this, there, room, refreshed] {
            checking_ = false;
            checked(room, there, refreshed);
        };
    });
}

void Recording::checked(const Result<double> &room, const Result<void> &there,
                        const Result<void> &refreshed) {
    isChecked_ = true;
    free_ = room ? std::optional<double>(*room) : std::nullopt;
    refreshError_ = refreshed ? std::nullopt : std::optional<Error>(refreshed.error());
    const double floor = settings_.number("record.free_floor_bytes");
    const std::optional<Error> failure = writer_.state().error;
    if (phase_ == Phase::Recording && !there)
        end(RecordingEnd::Failed, there.error());
    else if (phase_ == Phase::Recording && failure)
        end(RecordingEnd::Failed, failure);
    else if (phase_ == Phase::Recording && floor > 0 && free_ && *free_ <= floor)
        end(RecordingEnd::FreeSpace,
            diskError(
                QString("%1: the recording was ended at %2 MB of free space (record.free_floor_bytes is %3 "
                        "MB); what was written is whole")
                    .arg(folder_)
                    .arg(*free_ * 1e-6, 0, 'f', 1)
                    .arg(floor * 1e-6, 0, 'f', 1),
                folder_));
    updateHealth();
}

} // namespace hermes
