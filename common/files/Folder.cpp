#include "common/files/Folder.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonObject>

#include <sys/stat.h>

namespace hermes {

Result<void> makeFolder(const QString &path) {
    if (QDir().mkpath(path))
        return {};
    QFileInfo first(
        QDir::cleanPath(QFileInfo(path).absoluteFilePath())); // that is missing; Qt does not say why
    while (!QFileInfo::exists(first.path()))
        first.setFile(first.path());
    if (::mkdir(QFile::encodeName(first.filePath()).constData(), 0777) == 0)
        return makeFolder(path);
    return Error(ErrorCode::InputOutput,
                 QString("%1: the folder cannot be made: %2").arg(path, qt_error_string()),
                 QJsonObject{{"path", path}});
}

QString stateFolder() {
    const QString service = qEnvironmentVariable("STATE_DIRECTORY").section(QLatin1Char(':'), 0, 0);
    if (!service.isEmpty())
        return service;
    const QString state = qEnvironmentVariable("XDG_STATE_HOME");
    return (state.isEmpty() ? QDir::homePath() + "/.local/state" : state) + "/hermes";
}

} // namespace hermes
