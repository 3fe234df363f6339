#pragma once

#include "common/Result.h"

#include <QFile>
#include <QStringList>
#include <QThreadPool>
#include <optional>

namespace hermes::motorcontrol {

/// The emergency stop on the disk: it outlives the program, and a loss of power, until somebody releases it.
/// A daemon begins with the stop of one that had the same settings file, port or line, whatever else was set
/// in between, unless that one is still running. Lines of simulated robots do not count: each has the same. A
/// file has the reason in its first line, and in those after it by what its daemon is known.
class LatchFile {
public:
    LatchFile() { disk_.setMaxThreadCount(1); }
    ~LatchFile();
    /// The daemon has this settings file (empty: none), listens at these addresses and drives these lines.
    /// Nothing is kept where no address lasts: nobody could tell such a daemon from another.
    void setPlace(const QString &settingsFile, const QStringList &listen, const QStringList &lines);

    /// Takes room for a stop, so that a disk that fills does not lose it. Error: InputOutput.
    Result<void> reserve();
    /// Why the robot was stopped; nothing where no stop was latched. A file that cannot be read is a stop.
    std::optional<QString> read();
    /// At once, for a program that is killed; on the disk soon. Nothing: no stop is latched. Error:
    /// InputOutput.
    Result<void> write(const std::optional<QString> &reason);

private:
    QString draft() const { return path_ + ".new"; }
    /// Those that are on the disk, of this daemon.
    QStringList found() const;

    QString path_;
    QStringList marks_;              ///< this daemon is known by any of them
    QStringList taken_, takenMarks_; ///< of the stop that it began with: its files and their marks
    QFile file_;                     ///< locked, so that no other motor control takes it for its own
    bool isLatched_ = false;         ///< the file is at its path, not the draft
    QThreadPool disk_;               // a disk may take long; its jobs end before this does
};

} // namespace hermes::motorcontrol
