#include "common/recording/FileWatch.h"

#include "common/recording/DiskError.h"

#include <QDir>

#include <algorithm>
#include <set>
#include <sys/stat.h>

namespace hermes {
namespace {

Error missing(const QString &path, const QString &found) {
    return diskError(path + ": " + found + "; the recording is not complete", path);
}

} // namespace

Result<void> FileWatch::look(const QString &folder, const QString &logger, const QJsonArray &files) {
    const QStringList found = QDir(folder).entryList({logger + "-*"}, QDir::Files | QDir::System);
    std::set<QString> all(found.begin(), found.end());
    std::map<QString, double> written;
    for (const QJsonValue &file : files) {
        all.insert(file["name"].toString());
        written[file["name"].toString()] = file["bytes"].toDouble();
    }
    for (const auto &[path, seen] : seen_)
        all.insert(path.section('/', -1));
    for (const QString &name : all) {
        const QString path = folder + '/' + name;
        struct stat state;
        if (::stat(QFile::encodeName(path).constData(), &state) != 0)
            return missing(path, "the file was removed or moved away while it was recorded");
        const Identity identity(state.st_dev, state.st_ino);
        Seen &seen = seen_.emplace(path, Seen{identity}).first->second;
        const Identity known = seen.identity;
        seen.bytes = std::max(seen.bytes, written[name]);
        if (known != identity)
            return missing(path,
                           QString("another file has taken its place while it was recorded: found inode "
                                   "%1, expected %2")
                               .arg(identity.second)
                               .arg(known.second));
        if (double(state.st_size) < seen.bytes)
            return missing(path,
                           QString("the file was cut while it was recorded: found %1 bytes, expected %2")
                               .arg(qint64(state.st_size))
                               .arg(seen.bytes, 0, 'f', 0));
        seen.bytes = double(state.st_size);
    }
    return {};
}

} // namespace hermes
