#include "vectorlib/experiments/PlacesExperiment.h"

#include "vectorlib/experiments/PairsExperiment.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/mapping/MapBuilder.h"

#include <algorithm>

namespace hermes::experiments {

constexpr std::size_t searchTime = 10; // beside that of a scan that makes the map, about

vectorlib::EarSettings scannerOf(const vectorlib::CarmenScan &scan) {
    return vectorlib::EarSettings::forScanner(scan.angleStep * double(scan.ranges.size()),
                                              scan.ranges.size());
}

std::vector<vectorlib::MapEdge> mapOfHalf(const vectorlib::CarmenLog &log, const ProgressSink &progress) {
    vectorlib::MapBuilder build;
    for (std::size_t i = 0; i < log.scans.size(); i += 2) {
        build.extract.segment.settings = scannerOf(log.scans[i]);
        build.process(pointsOf(log.scans[i]), log.scans[i].laserPose);
        if (progress)
            progress(std::min(i + 2, log.scans.size()), log.scans.size());
    }
    return build.map.slots();
}

PlacesReport placesExperiment(const vectorlib::CarmenLog &log, const vectorlib::CarmenLog *other,
                              const ProgressSink &progress) {
    const std::vector<vectorlib::CarmenScan> &scans = other ? other->scans : log.scans;
    const std::size_t searches = other ? scans.size() : scans.size() / 2;
    ProgressParts parts(progress, {log.scans.size() / 2, searches * searchTime});
    const std::vector<vectorlib::MapEdge> map = mapOfHalf(log, parts.next());
    PlacesReport report;
    report.isSameBuilding = !other;
    report.mapSegments = std::size_t(std::count_if(
        map.begin(), map.end(), [](const vectorlib::MapEdge &edge) { return edge.observations > 0; }));
    PlaceTrials trials;
    trials.setMap(map);
    trials.expect(searches, parts.next());
    for (std::size_t i = other ? 0 : 1; i < scans.size(); i += other ? 1 : 2) {
        trials.extract.segment.settings = scannerOf(scans[i]);
        trials.add(pointsOf(scans[i]), other ? std::nullopt : std::optional(scans[i].laserPose)).scan = i;
    }
    report.trials = std::move(trials.all);
    return report;
}

nlohmann::ordered_json summaryOf(const PlacesReport &report) {
    nlohmann::ordered_json json = {{"map_segments", report.mapSegments}};
    json.update(summaryOf(report.trials));
    return json;
}

void writeCsv(std::ostream &out, const PlacesReport &report) {
    using vectorlib::Number;
    out << (report.isSameBuilding ? "scan,found,right,places,score,probability,error_m,error_deg,time_ms\n"
                                  : "scan,accepted,places,score,probability,time_ms\n");
    for (const PlaceTrial &t : report.trials) {
        out << t.scan << ',' << t.isFound() << ',';
        if (report.isSameBuilding)
            out << t.isRight() << ',';
        out << t.leads.size() << ',' << Number(t.score) << ',' << Number(t.probability) << ',';
        if (report.isSameBuilding)
            out << Number(t.metres) << ',' << Number(t.degrees) << ',';
        out << Number(t.milliseconds) << '\n';
    }
}

} // namespace hermes::experiments
