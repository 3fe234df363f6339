#pragma once

#include "common/Result.h"

#include <QString>
#include <map>

namespace hermes {

/// Brings what was written to a file, by whomever, to the disk. InputOutput when that fails. Blocks.
Result<void> syncFile(const QString &path);
/// New names of files in a folder last from then on, where the file system can. Blocks.
void syncFolder(const QString &path);

/// Brings all files of a logger in a folder to the disk that have grown since the last time. Those who write
/// go on meanwhile.
class FileSync {
public:
    Result<void> run(const QString &folder, const QString &logger);

private:
    std::map<QString, qint64> sizes_; ///< on the disk, by path
};

} // namespace hermes
