#include "common/recording/FileWatch.h"

#include "common/recording/DiskError.h"

#include <QDir>

#include <set>
#include <sys/stat.h>

namespace hermes {
namespace {

Error missing(const QString &path, const QString &found) {
    return diskError(path + ": " + found + "; the recording is not complete", path);
}

} // namespace

Result<void> FileWatch::look(const QString &folder, const QString &logger, const QStringList &names) {
    const QStringList found = QDir(folder).entryList({logger + "-*"}, QDir::Files | QDir::System);
    std::set<QString> all(found.begin(), found.end());
    all.insert(names.begin(), names.end());
    for (const auto &[path, identity] : seen_)
        all.insert(path.section('/', -1));
    for (const QString &name : all) {
        const QString path = folder + '/' + name;
        struct stat state;
        if (::stat(QFile::encodeName(path).constData(), &state) != 0)
            return missing(path, "the file was removed or moved away while it was recorded");
        const Identity identity(state.st_dev, state.st_ino);
        const Identity known = seen_.emplace(path, identity).first->second;
        if (known != identity)
            return missing(path,
                           QString("another file has taken its place while it was recorded: found inode "
                                   "%1, expected %2")
                               .arg(identity.second)
                               .arg(known.second));
    }
    return {};
}

} // namespace hermes
