#pragma once

#include "common/recording/FileWatch.h"
#include "common/recording/RecordingWriter.h"
#include "common/recording/SessionFolder.h"

namespace hermes {

/// How a recording ended, as its sidecar says. ShutDown: nobody stopped it, its logger ended in order. What
/// was cut off is found by the next start.
enum class RecordingEnd { Stopped, ShutDown, FreeSpace, Failed, CutOff };

/// The disk's side of one recording: folder, sidecar, room for its last version, the writer. Blocks: for a
/// thread that may. Not for several threads at once.
class RecordingSession {
public:
    struct Options {
        QString logger;
        QString root; ///< the folder of all recordings
        double fileBytes = 1e9;
        double fileSeconds = 3600;
        double floorBytes = 0; ///< free space at which a recording is not begun
        QJsonObject settings;  ///< for the sidecar
    };

    explicit RecordingSession(RecordingWriter &writer)
        : writer_(writer) {}

    /// Leaves nothing behind when it fails.
    Result<void> begin(const Options &options, const SessionName &session);
    /// Writes the sidecar as things stand.
    Result<void> refresh();
    /// Whether all files are where they were begun.
    Result<void> look();
    /// Ends the writer and completes the sidecar. error: why it ended, where it was not stopped.
    Result<void> finish(RecordingEnd end, const std::optional<Error> &error);

    bool isOpen() const { return lock_.isHeld(); }
    const QString &folder() const { return plan_.folder; }
    const QString &session() const { return session_; }
    const Moment &start() const { return plan_.start; }

    /// Completes what earlier processes left unfinished below the root; gives a line for each, and of what
    /// could not be completed. None of it when another process records there.
    struct Completed {
        QStringList done, failed;
        QJsonObject latest; ///< sidecar of what ended last on this host, cut off or not; empty: none
        double since_s = 0; ///< its end, as far as the clocks tell
    };
    static Completed completeAll(const Options &options, RecordingWriter &writer);

private:
    QJsonObject describe() const;
    QString ownReserve() const { return reservePath(plan_.folder, options_.logger); }
    QString sidecarPath() const;
    /// By the monotonic clock of the recording.
    double itsMono(const Moment &moment) const { return double(moment.mono_ns + plan_.toItsClock_ns) * 1e-9; }
    void abandon();

    RecordingWriter &writer_;
    Options options_;
    RecordingPlan plan_;
    QString session_;
    QJsonObject head_; ///< what of the sidecar stays as it was at the beginning
    FolderLock lock_;
    FileWatch watch_;
};

/// Bytes that a program without privileges may still write where the path is, or an error.
Result<double> freeBytes(const QString &path);

} // namespace hermes
