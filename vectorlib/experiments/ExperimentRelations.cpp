#include "vectorlib/experiments/ExperimentCommand.h"

#include "gui/vector/Failure.h"
#include "vectorlib/experiments/RelationAreas.h"
#include "vectorlib/experiments/RelationRun.h"

namespace hermes::experiments {

using vector::Failure;

void ExperimentCommand::freeHome(OutputSet &files, std::ostream &csv) const {
    relation(files, csv, homeScans(3069), halfTurnRays, vectorlib::pi,
             {{"scans", 3069}, {"length_m", 43.19}, {"mean_us", 3480}});
}

void ExperimentCommand::freeLeaps(OutputSet &files, std::ostream &csv) const {
    relation(files, csv, homeScans(23), halfTurnRays, vectorlib::pi, {{"scans", 23}, {"length_m", 43.19}});
}

void ExperimentCommand::freeLog(OutputSet &files, std::ostream &csv) const {
    const vectorlib::CarmenLog read = readLog();
    std::vector<PosedScan> scans;
    for (std::size_t i = 0; i < read.scans.size(); i += pairOptions.every) {
        scans.push_back({{}, read.scans[i].laserPose});
        read.scans[i].appendPoints(scans.back().points);
    }
    if (scans.empty())
        throw Failure(logs[0] + ": found no scan");
    const vectorlib::CarmenScan &scan = read.scans.front();
    relation(files, csv, scans, scan.ranges.size(), scan.angleStep * double(scan.ranges.size()), {});
}

void ExperimentCommand::freeCopy(OutputSet &files, std::ostream &csv) const {
    const std::vector<InjectedError> rows = injectedErrors(world("home"), options.seed);
    writeCsv(csv, rows);
    tell(open(files, ".json"), summaryOf(rows));
    draw(files, {plotsOf(rows), {}, {}});
}

void ExperimentCommand::freeApproach(OutputSet &files, std::ostream &csv) const {
    const ApproachResult result =
        approach(world("corner"), options.seed, pairOptions.every, options.progress);
    writeCsv(csv, result);
    tell(open(files, ".json"), summaryOf(result));
    draw(files, {plotsOf(result), {}, {}});
}

std::vector<PosedScan> ExperimentCommand::homeScans(std::size_t count) const {
    const World home = world("home");
    return scansAt(home, posesAlong(home, count), halfTurnScanner(options.seed));
}

void ExperimentCommand::relation(OutputSet &files, std::ostream &csv, const std::vector<PosedScan> &scans,
                                 std::size_t rays, double fieldOfView,
                                 const nlohmann::ordered_json &published) const {
    const RelationRun run = relationRun(scans, {fieldOfView, rays, options.progress});
    writeCsv(csv, run);
    tell(open(files, ".json"), summaryOf(run, published));
    draw(files, {plotsOf(run), {}, {}}, {{"ways", pictureOfWays(run)}});
}

} // namespace hermes::experiments
