#pragma once

#include "common/Result.h"

#include <QJsonObject>
#include <QString>

namespace hermes {

/// A recording of one logger that has ended, to be played: what its sidecar tells.
struct StoredRecording {
    QString folder; ///< absolute
    QJsonObject sidecar;
    double start_s = 0;  ///< since the epoch
    double length_s = 0; ///< as Sidecar::duration() gives it

    /// ROOT/NAME. InvalidParams: a wrong name; InputOutput: no sidecar of this logger is there, or it makes
    /// no sense; NotReady: it has not ended.
    static Result<StoredRecording> find(const QString &root, const QString &name, const QString &logger);
    /// The paths of its files, in order; none where nothing was to be recorded. InputOutput: a name leads out
    /// of the folder.
    Result<QStringList> files() const;
    /// InputOutput: a file is shorter than it was recorded; it names the first.
    Result<void> isWhole() const;
};

} // namespace hermes
