#pragma once

#include "common/Result.h"

#include <QJsonArray>
#include <QString>
#include <map>
#include <utility>

namespace hermes {

/// Notices when files of a recording under way are removed, moved away, replaced or cut: whoever writes them
/// does not, as an open file can be written to without its name.
class FileWatch {
public:
    /// Forgets what it has seen.
    void begin() { seen_.clear(); }
    /// Looks at all files of a logger in a folder. files: {name, bytes} of those that are there for sure,
    /// with at least so many bytes. InputOutput names the first file that is not what it was when it was seen
    /// first, or has become shorter. Blocks.
    Result<void> look(const QString &folder, const QString &logger, const QJsonArray &files);

private:
    using Identity = std::pair<quint64, quint64>; // device, inode

    struct Seen {
        Identity identity;
        double bytes = 0; ///< that it had at least
    };

    std::map<QString, Seen> seen_; ///< by path
};

} // namespace hermes
