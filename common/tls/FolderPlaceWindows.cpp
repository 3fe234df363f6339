#include "common/tls/FolderPlace.h"

#include <QDir>
#include <windows.h>

namespace hermes {

// Windows renames over no folder.
bool takePlace(const QString &folder, const QString &place) {
    const bool wasEmpty = QDir().rmdir(place);
    if (QDir().rename(folder, place))
        return true;
    const DWORD why = ::GetLastError();
    if (wasEmpty)
        QDir().mkdir(place);
    ::SetLastError(why);
    return false;
}

bool isAbsent(const QString &path) {
    const std::wstring name = QDir::toNativeSeparators(path).toStdWString();
    return ::GetFileAttributesW(name.c_str()) == INVALID_FILE_ATTRIBUTES &&
           ::GetLastError() == ERROR_FILE_NOT_FOUND;
}

} // namespace hermes
