#include "gui/vector/experiment/PlacesExperiment.h"

#include "gui/vector/experiment/ProcessorTime.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/places/PlaceSearch.h"

#include <algorithm>

namespace hermes::vector {

using Outcome = vectorlib::Relocalized::Outcome;

namespace {

std::vector<vectorlib::Vector2D<float>> pointsIn(const vectorlib::CarmenScan &scan) {
    std::vector<vectorlib::Vector2D<float>> points;
    scan.appendPoints(points);
    return points;
}

vectorlib::EarSettings scannerOf(const vectorlib::CarmenScan &scan) {
    return vectorlib::EarSettings::forScanner(scan.angleStep * double(scan.ranges.size()),
                                              scan.ranges.size());
}

PlaceResult resultOf(std::size_t number, const vectorlib::CarmenScan &scan,
                     const vectorlib::Relocalized &found) {
    PlaceResult r;
    r.scan = number;
    r.outcome = found.outcome;
    r.places = found.places.size();
    if (found.places.empty())
        return r;
    const vectorlib::Place &first = found.places.front();
    const vectorlib::Pose2D off = scan.laserPose.inverse() * first.pose;
    r.score = first.score;
    r.probability = first.probability;
    r.metres = std::hypot(off.x, off.y);
    r.degrees = std::abs(off.theta) * 180 / vectorlib::pi;
    return r;
}

} // namespace

PlacesReport placesExperiment(const vectorlib::CarmenLog &log, const vectorlib::CarmenLog *other,
                              const std::function<void(std::size_t done, std::size_t all)> &progress) {
    vectorlib::MapBuilder build;
    for (std::size_t i = 0; i < log.scans.size(); i += 2) {
        build.extract.segment.settings = scannerOf(log.scans[i]);
        build.process(pointsIn(log.scans[i]), log.scans[i].laserPose);
    }
    PlacesReport report;
    report.isSameBuilding = !other;
    report.mapSegments = build.map.size();
    vectorlib::EdgeExtractor extract;
    vectorlib::PlaceSearch search;
    search.index().follow(build.map.slots());
    const std::vector<vectorlib::CarmenScan> &scans = other ? other->scans : log.scans;
    for (std::size_t i = other ? 0 : 1; i < scans.size(); i += other ? 1 : 2) {
        extract.segment.settings = scannerOf(scans[i]);
        const auto points = pointsIn(scans[i]);
        const std::vector<vectorlib::EdgeRaw2D> &edges = extract(points);
        const double begin = processorMicroseconds();
        const vectorlib::Relocalized &found = search(build.map.slots(), edges, points);
        const double milliseconds = (processorMicroseconds() - begin) / 1000;
        report.results.push_back(resultOf(i, scans[i], found));
        report.results.back().milliseconds = milliseconds;
        if (progress)
            progress(i + 1, scans.size());
    }
    return report;
}

nlohmann::ordered_json summaryOf(const PlacesReport &report) {
    const std::vector<PlaceResult> &all = report.results;
    if (all.empty())
        return {{"map_segments", report.mapSegments}, {"scans", 0}};
    const auto share = [&](auto holds) {
        return double(std::count_if(all.begin(), all.end(), holds)) / double(all.size());
    };
    std::vector<double> times;
    for (const PlaceResult &r : all)
        times.push_back(r.milliseconds);
    std::sort(times.begin(), times.end());
    const auto outcome = [&](Outcome which) {
        return share([which](const PlaceResult &r) { return r.outcome == which; });
    };
    nlohmann::ordered_json json = {{"map_segments", report.mapSegments}, {"scans", all.size()}};
    if (report.isSameBuilding) {
        json["first_right"] = share([](const PlaceResult &r) { return r.isRight(); });
        json["first_within_10cm_2deg"] = share([](const PlaceResult &r) { return r.isWithin(0.1, 2); });
        json["found_right"] = share([](const PlaceResult &r) { return r.isFound() && r.isRight(); });
        json["found_within_10cm_2deg"] =
            share([](const PlaceResult &r) { return r.isFound() && r.isWithin(0.1, 2); });
    }
    json["found_wrong"] =
        share([&](const PlaceResult &r) { return r.isFound() && !(report.isSameBuilding && r.isRight()); });
    json["ambiguous"] = outcome(Outcome::Ambiguous);
    json["nowhere"] = outcome(Outcome::Nowhere);
    json["too_little"] = outcome(Outcome::TooLittle);
    json["unfinished"] = outcome(Outcome::Unfinished);
    json["median_ms"] = times[times.size() / 2];
    json["p99_ms"] = times[times.size() * 99 / 100];
    json["longest_ms"] = times.back();
    return json;
}

void writeCsv(std::ostream &out, const PlacesReport &report) {
    using vectorlib::Number;
    out << (report.isSameBuilding ? "scan,found,right,places,score,probability,error_m,error_deg,time_ms\n"
                                  : "scan,accepted,places,score,probability,time_ms\n");
    for (const PlaceResult &r : report.results) {
        out << r.scan << ',' << r.isFound() << ',';
        if (report.isSameBuilding)
            out << r.isRight() << ',';
        out << r.places << ',' << Number(r.score) << ',' << Number(r.probability) << ',';
        if (report.isSameBuilding)
            out << Number(r.metres) << ',' << Number(r.degrees) << ',';
        out << Number(r.milliseconds) << '\n';
    }
}

} // namespace hermes::vector
