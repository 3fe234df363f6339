#include "daemons/scanmatcher/MapFile.h"

#include "common/files/Folder.h"
#include "common/files/NamedFile.h"
#include "vectorlib/io/MapCsv.h"

#include <QDateTime>
#include <QDir>
#include <QDirIterator>
#include <QJsonObject>
#include <algorithm>
#include <sstream>

namespace hermes::scanmatcher {

Result<std::vector<vectorlib::MapEdge>> readMapFile(const MapPath &file) {
    const Result<QByteArray> bytes = readNamedFile(file.path, {file.folder}, largestMapFile);
    if (!bytes)
        return bytes.error();
    std::istringstream in(bytes->toStdString());
    auto map = vectorlib::readMapCsv(in, file.path.toStdString());
    if (!map)
        return Error(ErrorCode::InputOutput, QString::fromStdString(map.error().message()),
                     QJsonObject{{"path", file.path}});
    return std::move(*map);
}

MapList listMaps(const QString &folder) {
    constexpr int maxLookedAt = 100000; // a folder may be anything
    MapList list;
    QDirIterator files(folder, {"*.csv", "*.journal"}, QDir::Files | QDir::NoSymLinks,
                       QDirIterator::Subdirectories);
    for (int i = 0; files.hasNext() && i < maxLookedAt; ++i) {
        files.next();
        const QFileInfo file = files.fileInfo();
        list.maps.push_back({QDir(folder).relativeFilePath(file.filePath()),
                             isDriveJournal({file.filePath(), folder}), quint64(file.size()),
                             1e-3 * double(file.lastModified().toMSecsSinceEpoch())});
    }
    std::sort(list.maps.begin(), list.maps.end(),
              [](const ListedMap &a, const ListedMap &b) { return a.modified > b.modified; });
    if (list.maps.size() > maxListedMaps) {
        list.unlisted = list.maps.size() - maxListedMaps;
        list.maps.resize(maxListedMaps);
    }
    return list;
}

bool isDriveJournal(const MapPath &file) {
    return file.path.endsWith(".journal");
}

Result<RememberedDrive> readJournalFile(const MapPath &file) {
    const Result<QByteArray> bytes = readNamedFile(file.path, {file.folder}, largestJournal);
    if (!bytes)
        return bytes.error();
    return readDriveJournal(*bytes, file.path);
}

Result<SavedMap> writeMapFile(const MapPath &file, const QString &format, bool force,
                              const vectorlib::MapDrawing &map) {
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
    if (const Result<void> made = makeFolder(file.folder); !made)
        return made.error();
    if (const Result<void> written = writeNamedFile(file.path, {file.folder}, bytes, force); !written)
        return written.error();
    return SavedMap{file.path, map.segments.size(), quint64(bytes.size())};
}

} // namespace hermes::scanmatcher
