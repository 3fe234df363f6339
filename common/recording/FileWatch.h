#pragma once

#include "common/Result.h"

#include <QStringList>
#include <map>
#include <utility>

namespace hermes {

/// Notices when files of a recording under way are removed, moved away or replaced: whoever writes them does
/// not, as an open file can be written to without its name.
class FileWatch {
public:
    /// Forgets what it has seen.
    void begin() { seen_.clear(); }
    /// Looks at all files of a logger in a folder. names: of files that are there for sure. InputOutput names
    /// the first file that is not what it was when it was seen first. Blocks.
    Result<void> look(const QString &folder, const QString &logger, const QStringList &names);

private:
    using Identity = std::pair<quint64, quint64>; // device, inode

    std::map<QString, Identity> seen_; ///< by path
};

} // namespace hermes
