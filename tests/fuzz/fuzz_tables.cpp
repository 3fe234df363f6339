#include "tests/fuzz/FuzzInput.h"

#include <vectorlib/io/Csv.h>
#include <vectorlib/io/CsvPoints.h>
#include <vectorlib/io/MapCsv.h>
#include <vectorlib/io/Pcd.h>
#include <vectorlib/tls/TlsFit.h>

using namespace vectorlib;

namespace {

/// What the reader makes of the text; an error must name the file.
template <typename Reader>
auto readText(const std::string &text, Reader reader) {
    std::istringstream in(text);
    auto result = reader(in, "file");
    FUZZ_REQUIRE(result || result.error().message().rfind("file", 0) == 0);
    return result;
}

template <typename Scalar>
void requireFinite(const Expected<std::vector<Vector2D<Scalar>>> &points) {
    if (points)
        for (const Vector2D<Scalar> &p : *points)
            FUZZ_REQUIRE(p.isFinite());
}

bool isSound(const LineSegment2D<double> &s) {
    return s.isFinite() && s.direction().isFinite() && std::isfinite(s.length());
}

void readPoints(const std::string &text) {
    const auto points = readText(text, readCsvPoints<double>);
    requireFinite(points);
    requireFinite(readText(text, readCsvPoints<float>));
    requireFinite(readText(text, readPcd<double>));
    requireFinite(readText(text, readPcd<float>));
    if (!points)
        return;
    std::ostringstream out;
    writeCsvPoints(out, *points);
    const auto again = readText(out.str(), readCsvPoints<double>);
    FUZZ_REQUIRE(again && *again == *points);
}

void readSegments(const std::string &text) {
    if (const auto table = readText(text, readCsvSegments)) {
        FUZZ_REQUIRE(table->further.size() == table->segments.size());
        for (const auto &s : table->segments)
            FUZZ_REQUIRE(isSound(s));
        for (const auto &fields : table->further)
            FUZZ_REQUIRE(fields.size() == table->furtherNames.size());
    }
    if (const auto table = readText(text, readCsvPairs))
        for (const SegmentPair &pair : table->pairs)
            FUZZ_REQUIRE(isSound(pair.fixed) && isSound(pair.moving) && pair.weight > 0);
}

void readMap(const std::string &text) {
    const auto map = readText(text, readMapCsv);
    if (!map)
        return;
    for (const MapEdge &edge : *map) {
        FUZZ_REQUIRE(isSound(edge.segment) && isFinite(edge.sums) && edge.sums.n >= 0);
        const TlsLine fit = fitLine(edge.sums);
        FUZZ_REQUIRE(std::isfinite(fit.line.a) && std::isfinite(fit.line.b) && std::isfinite(fit.line.c));
        FUZZ_REQUIRE(std::isfinite(fit.variance) && lineCovariance(edge.sums).matrix.allFinite());
    }
    std::ostringstream out, again;
    writeMapCsv(out, *map);
    const auto back = readText(out.str(), readMapCsv);
    FUZZ_REQUIRE(back && back->size() == map->size());
    writeMapCsv(again, *back);
    FUZZ_REQUIRE(again.str() == out.str());
}

} // namespace

/// The same text for every reader of tables. What is read is finite, and comes back when it is written.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string text = fuzzText(data, size);
    readPoints(text);
    readSegments(text);
    readMap(text);
    return 0;
}
