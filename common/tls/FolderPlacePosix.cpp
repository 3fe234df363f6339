#include "common/tls/FolderPlace.h"

#include <QFile>
#include <cerrno>
#include <cstdio>
#include <sys/stat.h>

namespace hermes {

bool takePlace(const QString &folder, const QString &place) {
    return ::rename(QFile::encodeName(folder).constData(), QFile::encodeName(place).constData()) == 0;
}

bool isAbsent(const QString &path) {
    struct stat status {};
    return ::lstat(QFile::encodeName(path).constData(), &status) != 0 && errno == ENOENT;
}

} // namespace hermes
