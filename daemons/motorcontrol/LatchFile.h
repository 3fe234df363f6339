#pragma once

#include "common/Result.h"

#include <QString>
#include <QThreadPool>
#include <optional>

namespace hermes::motorcontrol {

/// The emergency stop on the disk: it outlives the program, and a loss of power, until somebody releases it.
class LatchFile {
public:
    LatchFile() { disk_.setMaxThreadCount(1); }
    /// The file of the daemon that listens at these addresses and drives these lines, in the folder of state.
    /// None where no address lasts: nobody could tell such a daemon from another.
    void setPlace(const QStringList &listen, const QStringList &lines);
    const QString &path() const { return path_; }

    /// Error: InputOutput, no stop could be written now.
    Result<void> mayBeWritten() const;
    /// Why the robot was stopped; nothing where no stop was latched. A file that cannot be read is a stop.
    std::optional<QString> read() const;
    /// At once, for a program that is killed; on the disk soon. Nothing: no stop is latched. Error:
    /// InputOutput.
    Result<void> write(const std::optional<QString> &reason);

private:
    QString path_;
    QThreadPool disk_; // a disk may take long; its jobs end before this does
};

} // namespace hermes::motorcontrol
