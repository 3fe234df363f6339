#include "common/progress/Progress.h"
#include "gui/vector/Options.h"
#include "gui/vector/Output.h"
#include "gui/vector/SegmentSet.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/places/PlaceSearch.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

namespace hermes::vector {

namespace {

using Json = nlohmann::ordered_json;
using Outcome = vectorlib::Relocalized::Outcome;
using Point = vectorlib::Vector2D<double>;
using vectorlib::SvgPicture;

Json placeAsJson(const vectorlib::Place &place) {
    Json covariance = nullptr;
    if (place.covariance)
        for (int r = 0; r < 3; ++r)
            covariance.push_back(
                {(*place.covariance)(r, 0), (*place.covariance)(r, 1), (*place.covariance)(r, 2)});
    return {{"pose", {{"x", place.pose.x}, {"y", place.pose.y}, {"alpha", place.pose.theta}}},
            {"covariance", covariance},
            {"accepted", place.fault == vectorlib::PlaceFault::None},
            {"verdict", describe(place.fault)},
            {"score", place.score},
            {"probability", place.probability},
            {"reliability", place.reliability},
            {"ambiguity", place.ambiguity},
            {"discrepancy", place.discrepancy},
            {"matched_share", place.matchedShare}};
}

/// A number as line segments, seven to a digit, for pictures that know no text: its lower left corner, and
/// the height of a digit, which is twice as high as wide.
std::vector<vectorlib::LineSegment2D<double>> drawnNumber(std::size_t number,
                                                          vectorlib::Vector2D<double> corner, double height) {
    // Ends of the seven strokes, in half heights, and which of them each digit has.
    static const Point strokes[7][2] = {{{0, 2}, {1, 2}}, {{1, 2}, {1, 1}}, {{1, 1}, {1, 0}},
                                        {{0, 0}, {1, 0}}, {{0, 0}, {0, 1}}, {{0, 1}, {0, 2}},
                                        {{0, 1}, {1, 1}}};
    constexpr unsigned digits[10] = {0x3f, 0x06, 0x5b, 0x4f, 0x66, 0x6d, 0x7d, 0x07, 0x7f, 0x6f};
    std::vector<vectorlib::LineSegment2D<double>> result;
    for (const char digit : std::to_string(number)) {
        for (unsigned i = 0; i < 7; ++i)
            if (digits[digit - '0'] >> i & 1u)
                result.emplace_back(corner + strokes[i][0] * (height / 2),
                                    corner + strokes[i][1] * (height / 2));
        corner.x += 0.75 * height;
    }
    return result;
}

std::string titleOf(const vectorlib::Relocalized &result) {
    const std::string text = result.text();
    return result.isFound() ? "Found" : "Not found: " + text;
}

/// Of a place: "scan and sensor, 0.31 probable at 2.00, 0.99, 29 degrees".
std::string wordsOf(const vectorlib::Place &place) {
    char text[96];
    std::snprintf(text, sizeof text, "scan and sensor, %.2f probable at %.2f, %.2f, %.0f degrees",
                  place.probability, place.pose.x, place.pose.y, place.pose.theta * 180 / vectorlib::pi);
    return text;
}

/// The larger side of the box around a map; metres.
double sizeOf(const SegmentSet &map) {
    Point low, high;
    bool isFirst = true;
    for (const vectorlib::LineSegment2D<double> &s : map.segments())
        for (const Point p : {s.begin(), s.end()}) {
            low = isFirst ? p : Point(std::min(low.x, p.x), std::min(low.y, p.y));
            high = isFirst ? p : Point(std::max(high.x, p.x), std::max(high.y, p.y));
            isFirst = false;
        }
    return std::max(high.x - low.x, high.y - low.y);
}

/// The scan at a place: its points, or the segments where it has none.
void drawScan(SvgPicture &picture, const SegmentSet &scan, const vectorlib::Transformation2D &pose,
              const SvgPicture::Style &style) {
    std::vector<Point> points;
    for (const vectorlib::Vector2D<float> &p : scan.points)
        points.push_back(pose * Point(p));
    std::vector<vectorlib::LineSegment2D<double>> segments;
    for (const vectorlib::LineSegment2D<double> &s : scan.segments())
        segments.push_back(pose * s);
    if (points.empty())
        picture.segments(style, segments);
    else
        picture.points(style, points);
}

/// The map, and the scan with its sensor where it was found. Places that fit alike are all drawn, numbered
/// from 1 as in the result, best first; of a search that found none the best place, as one that is refused.
SvgPicture pictureOf(const SegmentSet &map, const SegmentSet &scan, const vectorlib::Relocalized &result) {
    SvgPicture picture(titleOf(result));
    picture.segments({vectorlib::colour::map, 1.5, "map"}, map.segments());
    const bool isAmbiguous = result.outcome == Outcome::Ambiguous;
    const std::size_t shown = std::min(result.places.size(), isAmbiguous ? result.alike : std::size_t(1));
    const double height = 0.02 * sizeOf(map);
    for (std::size_t i = 0; i < shown; ++i) {
        const vectorlib::Place &place = result.places[i];
        const vectorlib::Transformation2D pose(place.pose);
        const std::string colour = isAmbiguous        ? vectorlib::colour::distinct(i)
                                   : result.isFound() ? vectorlib::colour::estimate
                                                      : vectorlib::colour::outliers;
        drawScan(picture, scan, pose, {colour, 4, ""});
        const std::string number = isAmbiguous ? std::to_string(i + 1) + ": " : "";
        picture.pose(
            {colour, 2, number + (result.isFound() || isAmbiguous ? "" : "refused: ") + wordsOf(place)},
            pose.translation(), pose.alpha());
        if (isAmbiguous) {
            const auto strokes = drawnNumber(i + 1, pose.translation() + Point(height, height) * 0.9, height);
            picture.segments({"#ffffff", 6, ""}, strokes);
            picture.segments({colour, 2.5, ""}, strokes);
        }
    }
    return picture;
}

struct RelocalizeCommand {
    std::string map, scan;
    double seconds = 3;
    SegmentSetSettings reading;
    OutputOptions output;

    void run() const {
        Outputs files(output);
        const SegmentSet known = loadSegmentSet(map, reading), seen = loadSegmentSet(scan, reading);
        if (known.kind == SegmentSet::Kind::Points)
            throw CLI::ValidationError("MAP", "found points in " + map + ", expected a map or segments");
        std::vector<vectorlib::MapEdge> slots;
        for (const vectorlib::LineSegment2D<double> &s : known.segments())
            slots.emplace_back(std::int64_t(slots.size()), vectorlib::EdgeRaw2D({}, s, 0), 1);
        std::vector<vectorlib::EdgeRaw2D> edges;
        for (const vectorlib::LineSegment2D<double> &s : seen.segments())
            edges.emplace_back(vectorlib::TlsSums(), s, 0);
        vectorlib::PlaceSearch search;
        search.maxSeconds = seconds;
        std::optional<Progress> progress("searching, step");
        double steps = 0;
        const auto begin = std::chrono::steady_clock::now();
        search.progress = [&](std::size_t done, std::size_t all) {
            const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
            steps = double(all);
            const double ofTime = std::floor(steps * std::min(1.0, passed.count() / seconds)); // it ends then
            progress->update(std::max(double(done), ofTime), steps);
        };
        const vectorlib::Relocalized &result = search(slots, edges, seen.points);
        progress->update(steps, steps);
        progress.reset();
        Json json = {{"outcome", vectorlib::name(result.outcome)},
                     {"text", result.text()},
                     {"alike", result.alike},
                     {"parts", result.parts},
                     {"searched", result.searched},
                     {"ms", result.ms},
                     {"places", Json::array()}};
        for (const vectorlib::Place &place : result.places)
            json["places"].push_back(placeAsJson(place));
        files.out << json.dump(2) << '\n';
        files.draw([&] { return pictureOf(known, seen, result); });
        files.commit();
    }
};

} // namespace

void addRelocalizeCommand(CLI::App &app) {
    const auto [sub, command] = addCommand<RelocalizeCommand>(
        app, "relocalize", "Find where in a whole map a scan was taken, without an expected pose (JSON)",
        "hermes-vector relocalize map.csv scan.csv --svg place.svg");
    sub->add_option("MAP", command->map, "A map by hermes-vector map, or segments (CSV x1,y1,x2,y2)")
        ->required();
    sub->add_option("SCAN", command->scan,
                    "One scan: points (CSV x,y or ascii PCD), or segments (CSV x1,y1,x2,y2); out of a log by "
                    "hermes-vector map LOG --scan N")
        ->required();
    addOption(*sub, "--sigma M", command->reading.sigma, aboveZero(),
              "Largest standard deviation of points from their line, metres")
        ->capture_default_str();
    addOption(*sub, "--seconds S", command->seconds, between(0.001, 1e6),
              "Longest search; what is left by then is not searched")
        ->capture_default_str();
    command->reading.segment.addTo(*sub, "defaults by the number of points");
    command->output.addTo(*sub, true);
}

} // namespace hermes::vector
