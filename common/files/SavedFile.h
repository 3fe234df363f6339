#pragma once

#include "common/Result.h"

#include <QSaveFile>

namespace hermes {

/// A file that takes the place of the one before when commit() succeeds: whole, and on the disk. Until then,
/// and when anything fails, nothing has changed. Errors: InputOutput with data.path.
class SavedFile : public QSaveFile {
public:
    using QSaveFile::QSaveFile;

    Result<void> begin() { return open(QIODevice::WriteOnly) ? Result<void>() : failure(); }
    /// Everything that was written is on the disk, but not in its place.
    Result<void> sync();
    Result<void> commit();

protected:
    qint64 writeData(const char *data, qint64 size) override;

private:
    Error failure() const;
};

Result<void> saveFile(const QString &path, const QByteArray &bytes);

} // namespace hermes
