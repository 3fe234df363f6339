#pragma once

#include "common/Result.h"
#include "daemons/scanmatcher/DriveJournal.h"
#include "daemons/scanmatcher/MatcherMessages.h"
#include "vectorlib/io/MapDrawing.h"

#include <vector>

namespace hermes::scanmatcher {

/// Largest file that readMapFile() takes: some 400,000 edges.
constexpr qint64 largestMapFile = 64 << 20;

/// A file that a client named, and the folder below which it has to be.
struct MapPath {
    QString path;
    QString folder;
};

/// Reads what writeMapFile() wrote as csv. Waits for the disk. InputOutput with data.path.
Result<std::vector<vectorlib::MapEdge>> readMapFile(const MapPath &file);

/// Files below the folder that are named as maps and journals are. Waits for the disk.
MapList listMaps(const QString &folder);

/// Whether it is named as journals are.
bool isDriveJournal(const MapPath &file);
/// Reads what a DriveJournal wrote, as readDriveJournal() does. Waits for the disk.
Result<RememberedDrive> readJournalFile(const MapPath &file);

/// Writes a map as csv, svg, geojson or dxf (only svg takes more than its segments); the file appears when it
/// is complete. Waits for the disk. InputOutput with data.path, also where the file
/// exists and force is not set.
Result<SavedMap> writeMapFile(const MapPath &file, const QString &format, bool force,
                              const vectorlib::MapDrawing &map);

} // namespace hermes::scanmatcher
