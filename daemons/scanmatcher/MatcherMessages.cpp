#include "daemons/scanmatcher/MatcherMessages.h"
#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"
#include "vectorlib/motion/OdometryFault.h"

#include <cmath>

namespace hermes::scanmatcher {

namespace {

constexpr double longestScan_s = 5;

const QString sinceTheEpoch = QStringLiteral(", in seconds since the Unix epoch, not in milliseconds");

Error wrong(const char *what, const QString &text) {
    return {ErrorCode::InvalidParams, QString("%1, %2").arg(what, text)};
}

Error wrongSize(const char *member, std::size_t found, std::size_t expected) {
    return wrong("scan", QString("member %1: found an array of %2, expected %3, as many as in x")
                             .arg(member)
                             .arg(found)
                             .arg(expected));
}

} // namespace

Result<Scan> readScan(WireView data, quint64 &unknown) {
    ReadReport report;
    auto message = readMessage<ScanMessage>(data, report);
    unknown += report.unknown;
    if (!message)
        return wrong("scan", report.text() + (report.path == "stamp" ? sinceTheEpoch : QString()));
    const std::size_t count = message->x.size();
    if (message->y.size() != count)
        return wrongSize("y", message->y.size(), count);
    if (message->t && message->t->size() != count)
        return wrongSize("t", message->t->size(), count);
    for (std::size_t i = 0; message->t && i < count; ++i)
        if (const double t = double((*message->t)[i]); !(std::abs(t) <= longestScan_s))
            return wrong("scan", QString("member t.%1: found %2, expected seconds after the stamp, of %3 at "
                                         "most; are these milliseconds?")
                                     .arg(i)
                                     .arg(t)
                                     .arg(longestScan_s));
    Scan scan;
    scan.number = message->header.turn;
    scan.partial = message->header.partial;
    scan.replayed = message->header.replayed;
    scan.data.stamp = message->header.stamp;
    scan.data.rays = std::size_t(message->header.rays.value_or(count));
    if (message->t)
        scan.data.seconds = std::move(*message->t);
    scan.data.points.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        scan.data.points.emplace_back(message->x[i], message->y[i]);
    return scan;
}

Result<vectorlib::OdometrySample> readOdometry(WireView data, double stamp, quint64 &unknown) {
    ReadReport report;
    const auto message = readMessage<OdometryMessage>(data, report);
    unknown += report.unknown;
    if (!message)
        return wrong("odometry", report.text());
    vectorlib::OdometrySample sample{stamp,
                                     message->pose,
                                     {message->twist.vx, message->twist.vy, message->twist.omega},
                                     Eigen::Matrix3d(Eigen::Matrix3d::Zero())};
    for (int i = 0; i < 9; ++i)
        (*sample.covariance)(i / 3, i % 3) = message->covariance[std::size_t(i)];
    if (const std::string fault = vectorlib::faultOf(sample); !fault.empty())
        return wrong("odometry", QString::fromStdString(fault));
    return sample;
}

using vectorlib::Place;
using vectorlib::Relocalized;

namespace {

PlaceAnswer answerOf(const Place &place) {
    PlaceAnswer answer{
        place.pose,      place.score,       place.probability,  place.reliability,
        place.ambiguity, place.discrepancy, place.matchedShare, place.fault == vectorlib::PlaceFault::None,
        std::nullopt};
    if (!answer.accepted)
        answer.fault = QString(vectorlib::describe(place.fault));
    return answer;
}

} // namespace

QString textOf(const Pose2D &pose) {
    const auto rounded = [](double value) {
        return QString::number(std::round(100 * value) / 100 + 0.0, 'f', 2);
    };
    return QString("x %1 m, y %2 m, theta %3 rad") // and no -0.00
        .arg(rounded(pose.x), rounded(pose.y), rounded(pose.theta));
}

SearchAnswer answerOf(const Relocalized &search) {
    SearchAnswer answer;
    answer.outcome = QString(vectorlib::name(search.outcome));
    for (const Place &place : search.places)
        answer.candidates.push_back(answerOf(place));
    answer.alike = quint64(search.alike);
    answer.parts = quint64(search.parts);
    answer.searched = quint64(search.searched);
    answer.ms = search.ms;
    return answer;
}

Fields<OdometryState> fieldsOf(Of<OdometryState>) {
    using S = OdometryState;
    return Fields<S>()
        .add("connected", &S::connected, "To the daemon that publishes it")
        .add("messages", &S::messages, "Taken")
        .add("refused", &S::refused, "That could not be read")
        .add("out_of_order", &S::outOfOrder, "Older than one before")
        .add("restarts", &S::restarts, "Times it began anew: a reset, or a gap")
        .add("dropped", &S::dropped, "By the source, as this daemon read too slowly")
        .add("unknown_fields", &S::unknownFields, "Members of messages that this program does not know")
        .add("scans_without", &S::scansWithout, "Scans that found no odometry of their time")
        .add("contradicted", &S::contradicted, "Pieces of way of which the scans show another");
}

Fields<SourceState> fieldsOf(Of<SourceState>) {
    using S = SourceState;
    return Fields<S>()
        .add("address", &S::address, "Of the daemon")
        .add("connected", &S::connected, "To it")
        .addOrNull("age_s", &S::age, "Since its last scan", "s")
        .add("scans", &S::scans, "Taken")
        .add("refused", &S::refused, "That could not be read")
        .add("dropped", &S::dropped, "As this daemon read too slowly")
        .add("unknown_fields", &S::unknownFields, "Members of scans that this program does not know")
        .add("use", &S::use,
             "Of the second scanner: on_trial, until it has agreed with the first at enough places; taken; "
             "contradicted, its scans are left out")
        .choices({"on_trial", "taken", "contradicted"})
        .add("paired", &S::paired, "Scans of the second scanner that went with one of the first")
        .add("apart", &S::apart, "Scans of the second scanner that were of another time than the first one's")
        .add("apart_s", &S::apart_s, "By which its last scan was older than the first one's", "s")
        .add("fitting", &S::fitting, "Where the second scanner seems to be on the robot, by what it sees");
}

Fields<MatcherState> fieldsOf(Of<MatcherState>) {
    using S = MatcherState;
    return Fields<S>()
        .add("active", &S::active, "Scans are taken")
        .add("mode", &S::mode, "mapping: the map grows; localization: it stays")
        .choices({"mapping", "localization"})
        .add("place", &S::place,
             "In the map: known; found by a search and not yet confirmed by a second one; told, and not "
             "yet "
             "confirmed by the scans; sought. While it is not known nothing is mapped")
        .choices({"known", "found", "told", "sought"})
        .add("undoes", &S::undoes, "The command that map.undo would undo; empty: none")
        .add("redoes", &S::redoes, "That it would carry out again with redo; empty: none")
        .add("scans", &S::scans, "Since the map is the one it is")
        .add("matched", &S::matched, "Of them")
        .add("lost", &S::lost, "Of them: no match was good enough")
        .add("skipped", &S::skipped, "Of them: too little to see")
        .add("doubted", &S::doubted, "Of the matched: the scan before shows something else")
        .add("restarts", &S::restarts,
             "Times that the map went on where a scan was expected, lost for too long")
        .add("waiting", &S::waiting, "Scans not yet matched")
        .add("dropped", &S::dropped, "As too many waited")
        .add("dropped_by_source", &S::droppedBySource, "As this daemon read too slowly")
        .add("refused", &S::refused, "That could not be read")
        .add("unknown_fields", &S::unknownFields, "Members of scans that this program does not know")
        .add("recoveries", &S::recoveries, "Searches of the whole map after lost scans")
        .add("recovered", &S::recovered, "Of them: found")
        .add("by_odometry", &S::byOdometry, "Scans whose pose was expected by odometry")
        .add("odometry", &S::odometry, "What comes as odometry")
        .add("sources", &S::sources, "Where scans come from, the first scanner first")
        .atMostElements(2)
        .add("ms_per_scan", &S::msPerScan, "Mean time to match one", "ms")
        .add("map_segments", &S::mapSegments, "Edges of the map")
        .add("key_scans", &S::keyScans, "Of the drive that is remembered to close loops")
        .add("closures", &S::closures, "Loops closed")
        .add("closures_tried", &S::closuresTried, "Pairs of key scans compared")
        .add("corrections", &S::corrections, "Times that the map was made anew")
        .add("loops_waiting", &S::loopsWaiting, "Scans not yet looked at for loops")
        .add("loops_dropped", &S::loopsDropped,
             "Scans that the drive is remembered without, as too many waited")
        .add("correction", &S::correction,
             "none; due: loops say that the drive bent; running: the map is being made anew")
        .add("remembered_mb", &S::rememberedMb, "Memory that the drive takes", "MB")
        .add("memory_full", &S::memoryFull,
             "It takes all of matcher.remember_mb: what is driven now is not remembered")
        .add("longest_stall_ms", &S::longestStallMs, "That matching waited for a map made anew", "ms");
}

Fields<PairMatch> fieldsOf(Of<PairMatch>) {
    using M = PairMatch;
    return Fields<M>()
        .include(&M::pose)
        .add("accepted", &M::accepted, "The match is good enough to be believed")
        .add("pairs", &M::pairs, "Segments that correspond")
        .add("reliability", &M::reliability, "0 to 1")
        .add("ambiguity", &M::ambiguity, "Of the position", "m^2")
        .add("matched_length", &M::matchedLength, "Of the segments in pairs", "m")
        .add("visible_length", &M::visibleLength, "Of all segments", "m")
        .add("ms", &M::ms, "Time it took", "ms");
}

Fields<PlaceAnswer> fieldsOf(Of<PlaceAnswer>) {
    using P = PlaceAnswer;
    return Fields<P>()
        .add("pose", &P::pose, "Of the sensor in the map's frame")
        .add("score", &P::score, "Places are ordered by it, the best first")
        .add("probability", &P::probability, "Of being right, 0 to 1")
        .add("reliability", &P::reliability, "Of the walls' directions, 0 to 1: small along a corridor")
        .add("ambiguity", &P::ambiguity, "Mean squared distance of the points from their walls", "m^2")
        .add("discrepancy", &P::discrepancy, "Area that was seen behind walls of the map", "m^2")
        .add("matched_share", &P::matchedShare, "Of the scan's points, that lie on walls of the map")
        .add("accepted", &P::accepted, "It stands all tests")
        .add("fault", &P::fault, "The test it failed")
        .orNull();
}

Fields<SearchAnswer> fieldsOf(Of<SearchAnswer>) {
    using S = SearchAnswer;
    return Fields<S>()
        .add("outcome", &S::outcome, "Of the search")
        .choices({"found", "no_scan", "no_map", "too_little", "nowhere", "ambiguous", "unfinished"})
        .add("candidates", &S::candidates, "The best places")
        .add("alike", &S::alike, "Places that fit about as well as the best one")
        .add("parts", &S::parts, "Of the search: a wall of the scan on a wall of the map")
        .add("searched", &S::searched, "Of them")
        .add("ms", &S::ms, "Time it took", "ms");
}

Fields<RelocalizeAnswer> fieldsOf(Of<RelocalizeAnswer>) {
    using R = RelocalizeAnswer;
    return Fields<R>()
        .include(&R::search)
        .include(&R::place)
        .add("applied", &R::applied, "The pose was taken over");
}

Fields<SavedMap> fieldsOf(Of<SavedMap>) {
    return Fields<SavedMap>()
        .add("path", &SavedMap::path, "Of the file")
        .add("segments", &SavedMap::segments, "Edges written")
        .add("bytes", &SavedMap::bytes, "Size of the file", "byte");
}

Fields<BroughtBack> fieldsOf(Of<BroughtBack>) {
    using B = BroughtBack;
    return Fields<B>()
        .add("command", &B::command,
             "That was undone, or carried out again: map.clear, map.load, pose.set, "
             "pose.relocalize or replay")
        .add("map", &B::map, "Another map is back")
        .add("pose", &B::pose, "The sensor is back at its place, moved by the way since; else it is sought")
        .add("segments", &B::segments, "Edges of the map")
        .add("at", &B::at, "Where the sensor is now expected");
}

Fields<ListedMap> fieldsOf(Of<ListedMap>) {
    return Fields<ListedMap>()
        .add("path", &ListedMap::path, "As map.load takes it")
        .add("journal", &ListedMap::isJournal, "It is the journal of a drive, else a map")
        .add("bytes", &ListedMap::bytes, "Size of the file", "byte")
        .add("modified", &ListedMap::modified, "When it was written, since the epoch", "s");
}

Fields<MapList> fieldsOf(Of<MapList>) {
    return Fields<MapList>()
        .add("maps", &MapList::maps, "The newest first")
        .atMostElements(maxListedMaps)
        .add("unlisted", &MapList::unlisted, "Older ones");
}

Fields<LoadedMap> fieldsOf(Of<LoadedMap>) {
    return Fields<LoadedMap>()
        .add("segments", &LoadedMap::segments, "Edges read, or made of a journal's scans")
        .add("scans", &LoadedMap::scans, "Scans that a journal remembers; 0: it is a map")
        .add("key_scans", &LoadedMap::keyScans, "Key scans among them")
        .add("closures", &LoadedMap::closures, "Loops among these")
        .add("left_out", &LoadedMap::leftOut, "Damaged bytes at the journal's end");
}

} // namespace hermes::scanmatcher
