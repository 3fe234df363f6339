#include "common/files/FilesSetting.h"

#include <QJsonArray>

namespace hermes {

Field namedFilesField() {
    return Field::array("files.folders", "Folders below which clients may name files to be read",
                        {{"type", "string"}})
        .byDefault(QJsonArray{"/"})
        .appliesOnRestart()
        .group("Files");
}

QStringList namedFilesFolders(const Settings &settings) {
    QStringList folders;
    for (const QJsonValue &folder : settings.value("files.folders").toArray())
        folders.append(folder.toString());
    return folders;
}

} // namespace hermes
