#include "common/progress/Progress.h"
#include "gui/vector/Options.h"
#include "gui/vector/Output.h"
#include "gui/vector/RelocalizePicture.h"
#include "gui/vector/SegmentSet.h"
#include "vectorlib/places/PlaceSearch.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

namespace hermes::vector {

namespace {

using Json = nlohmann::ordered_json;

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

struct RelocalizeCommand {
    std::string map, scan;
    double sigma = 0.03, seconds = 3;
    SegmentOptions segment;
    OutputOptions output;

    void run() const {
        SegmentSetSettings reading;
        reading.segmentation = [this](std::size_t points) {
            return segment.over(vectorlib::EarSettings::forScanner(2 * vectorlib::pi, points));
        };
        reading.sigma = sigma;
        OutputSet files(output.force);
        std::ostream &out = files.open(output.out);
        const PictureFiles pictures = output.openPictures(files);
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
        out << json.dump(2) << '\n';
        if (pictures.areWanted())
            pictures.write(pictureOf(known, seen, result));
        files.commit();
    }
};

} // namespace

void addRelocalizeCommand(CLI::App &app) {
    auto command = std::make_shared<RelocalizeCommand>();
    CLI::App *sub = app.add_subcommand(
        "relocalize", "Find where in a whole map a scan was taken, without an expected pose (JSON)");
    sub->add_option("MAP", command->map, "A map by hermes-vector map, or segments (CSV x1,y1,x2,y2)")
        ->required();
    sub->add_option("SCAN", command->scan,
                    "One scan: points (CSV x,y or ascii PCD), or segments (CSV x1,y1,x2,y2); out of a log by "
                    "hermes-vector map LOG --scan N")
        ->required();
    sub->add_option("--sigma", command->sigma, "Largest standard deviation of points from their line, metres")
        ->check(aboveZero())
        ->type_name("M")
        ->capture_default_str();
    sub->add_option("--seconds", command->seconds, "Longest search; what is left by then is not searched")
        ->check(between(0.001, 1e6))
        ->type_name("S")
        ->capture_default_str();
    command->segment.addTo(*sub, "defaults by the number of points");
    command->output.addTo(*sub, true);
    sub->footer(example("hermes-vector relocalize map.csv scan.csv --svg place.svg"));
    sub->callback([command] { command->run(); });
}

} // namespace hermes::vector
