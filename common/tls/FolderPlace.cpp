#include "common/tls/FolderPlace.h"

#include <QDir>

namespace hermes {

// Windows renames over no folder.
bool takePlace(const QString &folder, const QString &place) {
    QDir().rmdir(place); // where there is one, and nothing in it
    return QDir().rename(folder, place);
}

} // namespace hermes
