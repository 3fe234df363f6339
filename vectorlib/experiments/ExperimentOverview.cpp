#include "vectorlib/experiments/ExperimentCommand.h"

#include "vectorlib/experiments/BaselineExperiment.h"
#include "vectorlib/experiments/OverviewExperiment.h"

#include <cmath>

namespace hermes::experiments {

void ExperimentCommand::overviewSteps(OutputSet &files, std::ostream &csv) const {
    overview(files, csv, world("laboratory"), OdometryErrors::exaggerated(),
             {{"scans", 10}, {"step_m", 0.6}});
}

void ExperimentCommand::overviewLoop(OutputSet &files, std::ostream &csv) const {
    overview(files, csv, world("corridor"), OdometryErrors::usual(),
             {{"scans", 33}, {"length_m", 46.71}, {"runs", 1}, {"closing_error_m", 0.006}});
}

void ExperimentCommand::baseline(OutputSet &files, std::ostream &csv) const {
    std::vector<BaselineSet> sets;
    const std::vector<std::string> names = setNames(logs);
    for (std::size_t i = 0; i < logs.size(); ++i)
        sets.push_back(baselineSet(names[i], readPairs(logs[i], pairOptions), pairOptions));
    if (logs.empty())
        for (const char *place : {"laboratory", "corridor", "pillars"})
            sets.push_back(baselineSet(world(place), options.seed));
    std::ostream &json = open(files, ".json");
    const std::vector<BaselineRow> rows =
        baselineExperiment(sets, options.seed, logs.empty() ? options.runs : 1, options.progress);
    writeCsv(csv, rows);
    tell(json, summaryOf(rows));
    draw(files, {plotsOf(rows), {}, {}});
}

void ExperimentCommand::overview(OutputSet &files, std::ostream &csv, const World &world,
                                 const OdometryErrors &errors,
                                 const nlohmann::ordered_json &published) const {
    std::vector<OverviewRun> drives, older;
    for (int i = 0; i < options.runs; ++i) {
        drives.push_back(overviewRun(world, errors, options.seed + std::uint64_t(i)));
        older.push_back(
            overviewRun(world, errors, options.seed + std::uint64_t(i), OverviewMatcher::Quadrangle));
        options.progress(std::size_t(i) + 1, std::size_t(options.runs));
    }
    writeCsv(csv, drives);
    tell(open(files, ".json"), summaryOf(drives, older, published));
    const OverviewRun &first = drives.front();
    const std::string scans = std::to_string(first.scans.size()) + " scans";
    const auto millimetres = [](double metres) { return std::to_string(std::lround(1000 * metres)) + " mm"; };
    draw(files, {},
         {{"raw", pictureOfRaw(scans + ", not fitted: the last pose is " +
                                   millimetres(first.odometryClosingError()) + " off",
                               first)},
          {"scan", pictureOfScan("the first scan: clusters and lines", first.scans.front())},
          {"map", pictureOfMap("the map of " + scans + ": the last pose is " +
                                   millimetres(first.closingError()) + " off",
                               first)}});
}

} // namespace hermes::experiments
