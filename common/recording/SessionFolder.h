#pragma once

#include "common/recording/RecordingName.h"

#include <QString>

namespace hermes {

/// Which recording it is: what loggers that record together have in common.
struct SessionName {
    QString name;    ///< of its folder
    QString session; ///< its id; loggers given the same one share the folder
};

/// A logger's file in its folder for as long as it records: keeps the folder, and room for the sidecar.
QString reservePath(const QString &folder, const QString &logger);

/// Makes ROOT/NAME, or joins it where a logger of the same session has made it; puts the (empty) reserve into
/// it, gives its absolute path. Whatever was recorded stays: a folder of another session, or one in which
/// this logger has recorded, is refused (InputOutput, data.path), unless it goes on with what it recorded of
/// this session and has ended. The logger holds the lock of the root.
Result<QString> enterSessionFolder(const QString &root, const SessionName &session, const QString &logger,
                                   bool goesOn = false);

/// Held while a logger writes below a folder or repairs what is there, so that two of a kind do not disturb
/// each other. The system takes it from a process that dies.
class FolderLock {
public:
    FolderLock() = default;
    ~FolderLock() { release(); }
    FolderLock(const FolderLock &) = delete;
    FolderLock &operator=(const FolderLock &) = delete;

    /// Makes the folder. NotReady when another process has the lock, InputOutput when the folder cannot be
    /// written.
    Result<void> take(const QString &root, const QString &logger);
    void release();
    bool isHeld() const { return file_ >= 0; }

private:
    int file_ = -1;
};

} // namespace hermes
