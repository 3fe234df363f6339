#include "daemons/scanmatcher/MapFile.h"

#include "vectorlib/io/Dxf.h"
#include "vectorlib/io/GeoJson.h"
#include "vectorlib/io/MapCsv.h"

#include <QFile>
#include <QFileInfo>
#include <QJsonObject>
#include <QSaveFile>
#include <sstream>

namespace hermes::scanmatcher {

namespace {

Error fileError(const QString &path, const QString &what) {
    return {ErrorCode::InputOutput, path + ": " + what, QJsonObject{{"path", path}}};
}

} // namespace

Result<std::vector<vectorlib::MapEdge>> readMapFile(const QString &path) {
    // Before it is opened: a pipe would wait for its writer, and a device never ends.
    const QFileInfo info(path);
    if (info.exists() && (!info.isFile() || info.size() > largestMapFile))
        return fileError(path, QString("expected a map file of at most %1 bytes").arg(largestMapFile));
    QFile file(path);
    if (!file.open(QIODevice::ReadOnly))
        return fileError(path, "cannot read the map: " + file.errorString());
    std::istringstream in(file.read(largestMapFile).toStdString());
    auto map = vectorlib::readMapCsv(in, path.toStdString());
    if (!map)
        return Error(ErrorCode::InputOutput, QString::fromStdString(map.error().message()),
                     QJsonObject{{"path", path}});
    return std::move(*map);
}

Result<SavedMap> writeMapFile(const QString &path, const QString &format, bool force,
                              const vectorlib::MapDrawing &map) {
    if (QFileInfo::exists(path) && !force)
        return fileError(path, "exists already, expected a new name or force: true");
    std::ostringstream text;
    if (format == "svg")
        vectorlib::drawMap(text, map);
    else if (format == "geojson")
        vectorlib::writeGeoJson(text, map.segments);
    else if (format == "dxf")
        vectorlib::writeDxf(text, map.segments);
    else
        vectorlib::writeMapCsv(text, map.segments);
    const QByteArray bytes = QByteArray::fromStdString(text.str());
    QSaveFile file(path);
    if (!file.open(QIODevice::WriteOnly) || file.write(bytes) != bytes.size() || !file.flush() ||
        !file.commit()) // commit() alone does not notice a full disk
        return fileError(path, "cannot write the map: " + file.errorString());
    return SavedMap{path, map.segments.size(), quint64(bytes.size())};
}

} // namespace hermes::scanmatcher
