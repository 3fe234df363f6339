#include "common/files/FilesSetting.h"

#include <QJsonArray>

namespace hermes {

Field namedFilesField() {
    return Field::array(QStringLiteral("files.folders"),
                        QStringLiteral("Folders below which clients may name files to be read"),
                        {{QStringLiteral("type"), QStringLiteral("string")}})
        .byDefault(QJsonArray{QStringLiteral("/")})
        .appliesOnRestart()
        .group(QStringLiteral("Files"));
}

QStringList namedFilesFolders(const Settings &settings) {
    QStringList folders;
    for (const QJsonValue &folder : settings.value(QStringLiteral("files.folders")).toArray())
        folders.append(folder.toString());
    return folders;
}

} // namespace hermes
