#include "daemons/scanmatcher/ScanMatcher.h"

#include "vectorlib/io/Dxf.h"
#include "vectorlib/io/GeoJson.h"
#include "vectorlib/io/MapCsv.h"
#include "vectorlib/io/MapDrawing.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QSaveFile>
#include <sstream>

namespace hermes {

namespace {

constexpr qint64 maxMapBytes = 64 << 20; // some 400,000 edges

Error fileError(const QString &path, const QString &what) {
    return {ErrorCode::InputOutput, path + ": " + what, QJsonObject{{"path", path}}};
}

} // namespace

void ScanMatcher::declareMapCommands() {
    const QJsonObject saved{{"type", "object"},
                            {"properties", QJsonObject{{"path", QJsonObject{{"type", "string"}}},
                                                       {"segments", QJsonObject{{"type", "integer"}}},
                                                       {"bytes", QJsonObject{{"type", "integer"}}}}}};
    const Field path = Field::text("path", "File; relative to map.folder");
    const Field force = Field::boolean("force", "Overwrite a file that exists").byDefault(false);
    addCommand(
        Command("map.get",
                "The whole map: revision and edges with end points (m), points, sigma (m), observations")
            .returns({{"type", "object"}})
            .handler([this](const Call &) -> Result<QJsonValue> { return QJsonValue(mirror.full()); }));
    addCommand(Command("map.save", "Writes the map as CSV, so that map.load gives the same map")
                   .param(path)
                   .param(force)
                   .returns(saved)
                   .handler([this](const Call &call) {
                       return writeMapFile(call.text("path"), "csv", call.flag("force"));
                   }));
    addCommand(
        Command("map.export", "Writes the map in another format")
            .param(Field::text("format", "Of the file").choices({"svg", "csv", "geojson", "dxf"}))
            .param(path)
            .param(force)
            .returns(saved)
            .example({{"format", "svg"}, {"path", "office.svg"}},
                     QJsonObject{{"path", "/home/robot/office.svg"}, {"segments", 48}, {"bytes", 9120}})
            .handler([this](const Call &call) {
                return writeMapFile(call.text("path"), call.text("format"), call.flag("force"));
            }));
    addCommand(Command("map.load", "Replaces the map by one that map.save wrote")
                   .param(path)
                   .asyncHandler([this](const Call &call, const Reply &reply) {
                       auto segments = readMapFile(call.text("path"));
                       if (!segments)
                           return reply.error(segments.error());
                       const QJsonObject answer{{"segments", qint64(segments->size())}};
                       postMapChange(
                           [loaded = segments.take()](Tracker &tracker) {
                               tracker.clear();
                               for (const vectorlib::MapEdge &m : loaded)
                                   tracker.builder.map.add(m, m.observations);
                           },
                           reply, answer);
                   }));
    addCommand(Command("map.clear", "Forgets map, pose, trajectory and counts")
                   .returnsNull()
                   .asyncHandler([this](const Call &, const Reply &reply) {
                       postMapChange([](Tracker &tracker) { tracker.clear(); }, reply, QJsonValue());
                   }));
}

void ScanMatcher::postMapChange(const std::function<void(Tracker &)> &change, const Reply &reply,
                                const QJsonValue &answer) {
    worker->post([this, change, reply, answer](Tracker &tracker) {
        change(tracker);
        MapChanges changes = takeChanges(tracker.builder.map);
        changes.cleared = true;
        QMetaObject::invokeMethod(this, [this, changes, reply, answer] {
            counts = TrackerCounts();
            lostInARow = 0;
            lastRecovery.reset();
            mirror.apply(changes);
            publishSnapshot("map");
            reply.result(answer);
        });
    });
}

QString ScanMatcher::absolutePath(const QString &path) const {
    return QDir(const_cast<ScanMatcher *>(this)->settings().text("map.folder")).absoluteFilePath(path);
}

Result<QJsonValue> ScanMatcher::writeMapFile(const QString &path, const QString &format, bool force) const {
    const QString name = absolutePath(path);
    if (QFileInfo::exists(name) && !force)
        return fileError(name, "exists already, expected a new name or force: true");
    const std::vector<vectorlib::MapEdge> segments = mirror.segments();
    std::ostringstream text;
    if (format == "svg")
        vectorlib::drawMap(
            text, {"Map of " + std::to_string(counts.scans) + " scans", segments, mirror.trajectory(), {}});
    else if (format == "geojson")
        vectorlib::writeGeoJson(text, segments);
    else if (format == "dxf")
        vectorlib::writeDxf(text, segments);
    else
        vectorlib::writeMapCsv(text, segments);
    const QByteArray bytes = QByteArray::fromStdString(text.str());
    QSaveFile file(name);
    if (!file.open(QIODevice::WriteOnly) || file.write(bytes) != bytes.size() || !file.flush() ||
        !file.commit()) // commit() alone does not notice a full disk
        return fileError(name, "cannot write the map: " + file.errorString());
    return QJsonValue(
        QJsonObject{{"path", name}, {"segments", qint64(segments.size())}, {"bytes", qint64(bytes.size())}});
}

Result<std::vector<vectorlib::MapEdge>> ScanMatcher::readMapFile(const QString &path) const {
    const QString name = absolutePath(path);
    // Before it is opened: a pipe would wait for its writer, a device never ends, and the event loop with it.
    const QFileInfo info(name);
    if (info.exists() && (!info.isFile() || info.size() > maxMapBytes))
        return fileError(name, QString("expected a map file of at most %1 bytes").arg(maxMapBytes));
    QFile file(name);
    if (!file.open(QIODevice::ReadOnly))
        return fileError(name, "cannot read the map: " + file.errorString());
    std::istringstream in(file.read(maxMapBytes).toStdString());
    auto map = vectorlib::readMapCsv(in, name.toStdString());
    if (!map)
        return Error(ErrorCode::InputOutput, QString::fromStdString(map.error().message()),
                     QJsonObject{{"path", name}});
    return std::move(*map);
}

} // namespace hermes
