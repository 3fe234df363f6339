#pragma once

#include "common/recording/DiskError.h"

#include <QString>

namespace hermes::velodynelogger {

/// The folder of the settings in which captured turns are kept, beside the recordings.
class RecordFolder {
public:
    void setPath(const QString &path) { path_ = path; }
    const QString &path() const { return path_; }

    /// The path of a new file NAME.SUFFIX; makes the folder where it is missing. Refuses names that lead out
    /// of the folder (InvalidParams) and files that exist (InputOutput, data.path).
    Result<QString> newFile(const QString &name, const QString &suffix) const;

private:
    QString path_;
};

} // namespace hermes::velodynelogger
