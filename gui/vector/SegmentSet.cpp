#include "gui/vector/SegmentSet.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "vectorlib/edges/EdgeExtractor.h"
#include "vectorlib/io/Csv.h"
#include "vectorlib/io/CsvPoints.h"
#include "vectorlib/io/MapCsv.h"
#include "vectorlib/io/Pcd.h"
#include "vectorlib/segmentation/ScanOrder.h"

#include <algorithm>
#include <sstream>

namespace hermes::vector {

using Kind = SegmentSet::Kind;

namespace {

constexpr double endNoise = 0.01; // metres

/// By the first line that is neither empty nor a comment.
Kind kindOf(const std::string &text) {
    std::istringstream in(text);
    std::string line;
    while (std::getline(in, line)) {
        const std::string_view row = vectorlib::trimmed(line);
        if (row.empty() || row.front() == '#')
            continue;
        std::vector<std::string_view> fields;
        vectorlib::splitCommas(row, fields);
        const auto has = [&](const char *name) {
            return std::find(fields.begin(), fields.end(), name) != fields.end();
        };
        if (has("x1"))
            return has("mean_x") ? Kind::Map : Kind::Segments;
        return has("x") || fields.size() < 4 ? Kind::Points : Kind::Segments;
    }
    return Kind::Points; // whose reader tells what is wrong
}

void take(SegmentSet &set, const vectorlib::EdgeRaw2D &edge, double noise) {
    set.measured.segments.push_back(edge.segment);
    set.measured.lines.push_back(vectorlib::lineCovariance(edge.sums, noise));
}

/// Counter-clockwise, so that free space lies on the left of segments: some scanners, the HDL-32E among them,
/// turn the other way.
std::vector<vectorlib::Vector2D<float>> inOrder(const std::vector<vectorlib::Vector2D<float>> &points) {
    vectorlib::ScanOrder order;
    const vectorlib::PointSpan<float> ordered = order(points);
    return {ordered.begin(), ordered.end()};
}

void vectorize(SegmentSet &set, const SegmentSetSettings &settings) {
    vectorlib::EdgeExtractor extract;
    extract.segment.settings = settings.segmentation(set.points.size());
    extract.vectorize.settings.sigma = settings.sigma;
    for (const vectorlib::EdgeRaw2D &edge : extract(vectorlib::PointSpan<float>(set.points)))
        take(set, edge, settings.noise);
}

} // namespace

SegmentSet loadSegmentSet(const std::string &path, const SegmentSetSettings &settings) {
    Input input(path);
    std::string text = readScanText(input, path);
    SegmentSet set;
    const bool isPcd = hasExtension(path, ".pcd");
    set.kind = isPcd ? Kind::Points : kindOf(text);
    TextStream in(std::move(text));
    switch (set.kind) {
    case Kind::Points:
        set.points = inOrder(valueOrFail(isPcd ? vectorlib::readPcd<float>(in, input.name())
                                               : vectorlib::readCsvPoints<float>(in, input.name())));
        vectorize(set, settings);
        break;
    case Kind::Segments:
        for (const vectorlib::LineSegment2D<double> &s :
             valueOrFail(vectorlib::readCsvSegments(in, input.name())).segments) {
            const vectorlib::Vector2D<double> ends[] = {s.begin(), s.end()};
            const auto sums = vectorlib::TlsSums::of(std::begin(ends), std::end(ends));
            take(set, {sums, s, 0}, settings.noise > 0 ? settings.noise : endNoise);
        }
        break;
    case Kind::Map:
        for (const vectorlib::MapEdge &edge : valueOrFail(vectorlib::readMapCsv(in, input.name())))
            take(set, edge, settings.noise);
        break;
    }
    return set;
}

} // namespace hermes::vector
