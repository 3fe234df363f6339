#pragma once

#include "common/Result.h"
#include "protocol/messages/Motion.h"
#include "protocol/wire/WireValue.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/places/Relocalized.h"

#include <QString>

#include <optional>
#include <vector>

namespace hermes::scanmatcher {

/// A scan as a logger publishes it.
struct Scan {
    quint64 number = 0;
    bool partial = false; ///< not a whole turn: the first or last of a stream
    bool replayed = false;
    bool upsideDown = false; ///< as the scanner sees it; not data any more
    vectorlib::TimedScan data;
};

/// Reads a `scan2d` message; only stamp, x and y must be there. Without `rays` the scanner is taken to have
/// had a return of each. The error says which member is wrong, what was found and what was expected. unknown
/// counts members that this program does not know.
Result<Scan> readScan(WireView data, quint64 &unknown);

/// Reads an `odometry` message: pose, twist and covariance must be there.
Result<vectorlib::OdometrySample> readOdometry(WireView data, double stamp, quint64 &unknown);

/// What comes as odometry, since the source was opened.
struct OdometryState {
    bool connected = false;
    quint64 messages = 0, refused = 0, outOfOrder = 0, restarts = 0, dropped = 0, unknownFields = 0;
    quint64 scansWithout = 0;
    quint64 contradicted = 0;
};

/// A source of scans, since this program began; of the second scanner what is made of it.
struct SourceState {
    QString address;
    bool connected = false;
    std::optional<double> age; ///< of the last scan; seconds
    quint64 scans = 0, refused = 0, dropped = 0, unknownFields = 0;
    std::optional<QString> use;
    std::optional<quint64> paired, apart;
    std::optional<double> apart_s;
    std::optional<Pose2D> fitting;
};

/// What matcher.state gives.
struct MatcherState {
    bool active = false;
    QString mode, place, undoes, redoes;
    quint64 scans = 0, matched = 0, lost = 0, skipped = 0, doubted = 0, restarts = 0;
    quint64 waiting = 0, dropped = 0, droppedBySource = 0, refused = 0, unknownFields = 0;
    quint64 recoveries = 0, recovered = 0, byOdometry = 0;
    OdometryState odometry;
    std::vector<SourceState> sources;
    double msPerScan = 0;
    quint64 mapSegments = 0;
    quint64 keyScans = 0, closures = 0, closuresTried = 0, corrections = 0;
    quint64 loopsWaiting = 0, loopsDropped = 0;
    QString correction;
    double rememberedMb = 0;
    bool memoryFull = false;
    double longestStallMs = 0;
};

/// What matcher.match gives.
struct PairMatch {
    Pose2D pose;
    bool accepted = false;
    quint64 pairs = 0;
    double reliability = 0, ambiguity = 0, matchedLength = 0, visibleLength = 0, ms = 0;
};

/// A place in the map where a scan may have been taken.
struct PlaceAnswer {
    Pose2D pose;
    double score = 0, probability = 0, reliability = 0, ambiguity = 0, discrepancy = 0, matchedShare = 0;
    bool accepted = false;
    std::optional<QString> fault;
};

/// The search of a whole map for a scan; the best place beside it when one was found.
struct SearchAnswer {
    QString outcome;
    std::vector<PlaceAnswer> candidates;
    quint64 alike = 0, parts = 0, searched = 0;
    double ms = 0;
};

/// What pose.relocalize gives.
struct RelocalizeAnswer {
    SearchAnswer search;
    PlaceAnswer place;
    bool applied = false;
};

/// A map that was written.
struct SavedMap {
    QString path;
    quint64 segments = 0, bytes = 0;
};

/// A file that map.load takes.
struct ListedMap {
    QString path; ///< below the folder of maps
    bool isJournal = false;
    quint64 bytes = 0;
    double modified = 0; ///< seconds since the epoch
};
constexpr std::size_t maxListedMaps = 200;
struct MapList {
    std::vector<ListedMap> maps;
    quint64 unlisted = 0; ///< older ones
};

/// A map that was read.
struct LoadedMap {
    quint64 segments = 0;
    quint64 scans = 0, keyScans = 0, closures = 0; ///< of a journal
    quint64 leftOut = 0;                           ///< bytes at its end
};

/// What map.undo gives.
struct BroughtBack {
    QString command;
    bool map = false, pose = false;
    quint64 segments = 0;
    Pose2D at;
};

/// For people.
QString textOf(const Pose2D &pose);
SearchAnswer answerOf(const vectorlib::Relocalized &search);

Fields<OdometryState> fieldsOf(Of<OdometryState>);
Fields<SourceState> fieldsOf(Of<SourceState>);
Fields<MatcherState> fieldsOf(Of<MatcherState>);
Fields<PairMatch> fieldsOf(Of<PairMatch>);
Fields<PlaceAnswer> fieldsOf(Of<PlaceAnswer>);
Fields<SearchAnswer> fieldsOf(Of<SearchAnswer>);
Fields<RelocalizeAnswer> fieldsOf(Of<RelocalizeAnswer>);
Fields<SavedMap> fieldsOf(Of<SavedMap>);
Fields<LoadedMap> fieldsOf(Of<LoadedMap>);
Fields<BroughtBack> fieldsOf(Of<BroughtBack>);
Fields<ListedMap> fieldsOf(Of<ListedMap>);
Fields<MapList> fieldsOf(Of<MapList>);

} // namespace hermes::scanmatcher
