#include "daemons/scanmatcher/DriveJournal.h"
#include "tests/fuzz/FuzzInput.h"

using namespace hermes;
using namespace hermes::scanmatcher;

namespace {

/// Blocks whose sums are right, so that what is in them is looked at: each begins with its length.
QByteArray journalOf(FuzzInput &in) {
    QByteArray bytes;
    while (in.left() > 0 || bytes.isEmpty()) {
        const std::string content = in.bytes(in.take<std::uint16_t>());
        bytes += journal::item(QByteArray(content.data(), int(content.size())), bytes.isEmpty());
    }
    return bytes;
}

bool isFinite(const vectorlib::Pose2D &p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.theta);
}

} // namespace

/// A journal that is read is a drive that can go on: its numbers fit each other, its poses are finite, also
/// once they are corrected and the map is made of it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    const bool isWhole = in.flag();
    const std::string raw = isWhole ? in.bytes(size) : std::string();
    const QByteArray bytes = isWhole ? QByteArray(raw.data(), int(raw.size())) : journalOf(in);
    auto read = readDriveJournal(bytes, "a.journal");
    if (!read) {
        FUZZ_REQUIRE(read.error().message.startsWith("a.journal: byte "));
        return 0;
    }
    vectorlib::MappedDrive &drive = read->drive;
    FUZZ_REQUIRE(read->leftOut >= 0 && read->leftOut < bytes.size());
    FUZZ_REQUIRE(drive.loops.scans() > 0 && drive.loops.scans() == drive.edges().size());
    FUZZ_REQUIRE(read->trust.size() == drive.loops.scans());
    drive.loops.correct();
    const std::vector<vectorlib::Vector2D<float>> points{{1, 0}, {1, 0.1F}, {1, 0.2F}};
    drive.add(points, {}, vectorlib::Transformation2D(0.5, 0, 0), vectorlib::TrackedBy::Placed);
    for (const vectorlib::Pose2D &pose : drive.loops.poses())
        FUZZ_REQUIRE(isFinite(pose));
    vectorlib::MapBuilder builder;
    drive.rebuild(builder);
    drive.review(builder.map, drive.loops.poses());
    builder.map.forEach([](const vectorlib::MapEdge &e) {
        FUZZ_REQUIRE(std::isfinite(e.segment.begin().x) && std::isfinite(e.segment.end().y));
    });
    return 0;
}
