#include "common/Log.h"
#include "daemons/scanmatcher/MapFile.h"
#include "daemons/scanmatcher/ScanMatcher.h"
#include "protocol/wire/Fields.h"

#include <QDir>

namespace hermes::scanmatcher {

namespace {

constexpr int maxFiles = 4; // that may wait to be written, each with its copy of the map

} // namespace

void ScanMatcher::declareMapCommands() {
    const Field path = Field::text("path", "File below map.folder, relative to it");
    const Field force = Field::boolean("force", "Overwrite a file that exists").byDefault(false);
    addCommand(Command("map.get", "The whole map").needs(Role::Observer).answers([this](const Call &) {
        return mirror_.full();
    }));
    addCommand(
        Command("map.save", "Writes the map as CSV, so that map.load gives the same map")
            .needs(Role::Engineer)
            .param(path)
            .param(force)
            .gives<SavedMap>()
            .asyncHandler([this](const Call &call, const Reply &reply) { saveMap("csv", call, reply); }));
    addCommand(
        Command("map.export", "Writes the map in another format")
            .needs(Role::Engineer)
            .param(Field::text("format", "Of the file").choices({"svg", "csv", "geojson", "dxf"}))
            .param(path)
            .param(force)
            .gives<SavedMap>()
            .example({{"format", "svg"}, {"path", "office.svg"}},
                     QJsonObject{{"path", "/home/robot/office.svg"}, {"segments", 48}, {"bytes", 9120}})
            .asyncHandler(
                [this](const Call &call, const Reply &reply) { saveMap(call.text("format"), call, reply); }));
    addCommand(Command("map.load",
                       "Replaces the map by one that map.save wrote, or goes on with the drive of "
                       "a journal")
                   .needs(Role::Engineer)
                   .param(path)
                   .with("x-destructive", "the map, which map.undo brings back, and the remembered drive")
                   .gives<LoadedMap>()
                   .asyncHandler([this](const Call &call, const Reply &reply) {
                       worker_->post([this, file = mapPath(call), reply] { reply.give(map_->load(file)); });
                   }));
    addCommand(Command("map.list", "The maps and journals below map.folder, the newest first")
                   .needs(Role::Observer)
                   .gives<MapList>()
                   .asyncHandler([this](const Call &, const Reply &reply) {
                       files_.start([folder = QDir(settings().text("map.folder")).absolutePath(), reply] {
                           reply.result(asJson(listMaps(folder)));
                       });
                   }));
    addCommand(Command("map.undo",
                       "Undoes the last map.clear, map.load, pose.set, pose.relocalize or replay: its map "
                       "or pose is back, then that of the one before. What was mapped since the sensor was "
                       "put elsewhere goes, too. Where a map is back the pose is sought in it, unless it "
                       "is known; its drive is not remembered")
                   .param(Field::boolean("redo", "Carry out again what was undone last").byDefault(false))
                   .gives<BroughtBack>()
                   .asyncHandler([this](const Call &call, const Reply &reply) {
                       worker_->post(
                           [this, again = call.flag("redo"), reply] { reply.give(map_->undo(again)); });
                   }));
    addCommand(Command("map.clear", "Forgets map, pose, trajectory and counts")
                   .with("x-destructive", "the map, which map.undo brings back, and the remembered drive")
                   .returnsNull()
                   .asyncHandler([this](const Call &, const Reply &reply) {
                       worker_->post([this, reply] {
                           map_->clear();
                           reply.result(QJsonValue());
                       });
                   }));
}

MapPath ScanMatcher::mapPath(const Call &call) {
    const QDir folder(settings().text("map.folder"));
    return {folder.absoluteFilePath(call.text("path")), folder.absolutePath()};
}

// The worker gives a copy of the map as it is after the commands before this one, and goes on matching.
void ScanMatcher::saveMap(const QString &format, const Call &call, const Reply &reply) {
    if (isDriveJournal(mapPath(call)))
        return reply.error(
            {ErrorCode::InvalidParams,
             QString("path is \"%1\", expected another ending: files that end in .journal hold "
                     "drives, and a map in one could not be loaded")
                 .arg(call.text("path"))});
    if (filesUnderWay_ >= maxFiles)
        return reply.error(
            {ErrorCode::NotReady, QString("%1 files are being written already").arg(maxFiles)});
    ++filesUnderWay_;
    const auto map = std::make_shared<vectorlib::MapDrawing>();
    if (format == "svg")
        *map = {"Map of " + std::to_string(counts_.scans) + " scans", {}, mirror_.trajectory(), {}};
    const auto write = [this, map, format, file = mapPath(call), force = call.flag("force"), reply] {
        const Result<SavedMap> saved = writeMapFile(file, format, force, *map);
        if (!saved && format == "csv")
            QMetaObject::invokeMethod(this, [this] { mirror_.setSaved(false); });
        reply.give(saved);
        --filesUnderWay_;
    };
    worker_->post([this, map, write, isSaved = format == "csv"] {
        if (isSaved) // as soon as what the scans before gave is shown
            QMetaObject::invokeMethod(this, [this] { mirror_.setSaved(true); });
        map_->map().forEach([&](const vectorlib::MapEdge &edge) { map->segments.push_back(edge); });
        files_.start(write);
    });
}

} // namespace hermes::scanmatcher
