#pragma once

#include "common/Result.h"

#include <QJsonArray>
#include <QString>

namespace hermes {

/// The folder of the settings in which recordings and captured turns are kept.
class RecordFolder {
public:
    void setPath(const QString &path) { path_ = path; }
    const QString &path() const { return path_; }

    /// The path of a new file NAME.SUFFIX; makes the folder where it is missing. Refuses names that lead out
    /// of the folder (InvalidParams) and files that exist (InputOutput, data.path).
    Result<QString> newFile(const QString &name, const QString &suffix) const;
    /// {name, bytes, modified} of each recording, the latest first.
    QJsonArray list() const;

private:
    QString path_;
};

/// An error of the disk: InputOutput with data.path.
Error diskError(const QString &message, const QString &path);

} // namespace hermes
