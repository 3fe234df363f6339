#include "vectorlib/experiments/ExperimentCommand.h"

#include "vectorlib/experiments/Calibration.h"
#include "vectorlib/experiments/GlobalPairsExperiment.h"
#include "vectorlib/experiments/PlaceTrustFit.h"
#include "vectorlib/experiments/PlaceTrustTrials.h"
#include "vectorlib/experiments/PlacesExperiment.h"
#include "vectorlib/experiments/PoseTrustTrials.h"

#include <iostream>
#include <optional>

namespace hermes::experiments {

void ExperimentCommand::pairs(OutputSet &files, std::ostream &csv) const {
    if (logs.size() != 1)
        readLog(); // tells what is missing
    const vectorlib::CarmenLog read = readPairs(logs[0], pairOptions);
    if (noGuess)
        pairs(files, csv, read, globalPairsExperiment(read, pairOptions),
              [](const GlobalPairResult &pair) { return pair.best(); });
    else
        pairs(files, csv, read, pairsExperiment(read, pairOptions),
              [](const PairResult &pair) { return pair.match.pose; });
}

template <typename Result, typename Pose>
void ExperimentCommand::pairs(OutputSet &files, std::ostream &csv, const vectorlib::CarmenLog &read,
                              const std::vector<Result> &results, Pose found) const {
    std::ostream &json = open(files, ".json");
    writeCsv(csv, results);
    tell(json, summaryOf(results));
    std::size_t drawn = 0;
    for (const Result &pair : results)
        if (!pair.isWithin(found(pair), 0.10) && drawn++ < pictures)
            experiments::draw(open(files, "-" + std::to_string(pair.from) + ".svg"), read, pair, found(pair));
}

void ExperimentCommand::calibration(OutputSet &files, std::ostream &csv) const {
    if (logs.empty())
        readLog(); // tells what is missing
    std::vector<vectorlib::CarmenLog> read;
    std::vector<PairsOptions> of(logs.size(), pairOptions);
    std::vector<std::size_t> steps; // points of the scans: the more there are, the longer a pair takes
    for (std::size_t i = 0; i < logs.size(); ++i) {
        of[i].every = every[std::min(i, every.size() - 1)];
        read.push_back(readPairs(logs[i], of[i]));
        steps.push_back(of[i].pairsOf(read[i]).size() * read[i].scans.front().ranges.size());
    }
    ProgressParts parts(options.progress, steps);
    std::vector<GlobalPairResult> results;
    for (std::size_t i = 0; i < logs.size(); ++i) {
        of[i].progress = parts.next();
        for (GlobalPairResult &pair : globalPairsExperiment(read[i], of[i]))
            results.push_back(std::move(pair));
    }
    const Calibration found = calibrationOf(results);
    writeCsv(csv, found);
    std::cout << summaryOf(found).dump(2) << '\n';
    draw(files, {{plotOf(found)}, {}, {}});
}

void ExperimentCommand::places(OutputSet &files, std::ostream &csv) const {
    const vectorlib::CarmenLog read = readLog();
    std::optional<vectorlib::CarmenLog> strange;
    if (!others.empty())
        strange = readLog(others[0]);
    std::ostream &json = open(files, ".json"); // before the work, as the table is
    const PlacesReport report = placesExperiment(read, strange ? &*strange : nullptr, options.progress);
    writeCsv(csv, report);
    tell(json, summaryOf(report));
}

void ExperimentCommand::drawnPlaces(OutputSet &files, std::ostream &csv) const {
    std::ostream &json = open(files, ".json");
    const std::vector<World> found = allWorlds();
    ProgressParts parts(options.progress,
                        {stepsOfDrawnPlaces(found.size(), options.runs), stepsOfTowns(options.runs)});
    ExperimentOptions each = options;
    each.progress = parts.next();
    std::vector<PlaceTrial> trials = drawnPlacesExperiment(found, each);
    each.progress = parts.next();
    const std::vector<PlaceTrial> towns = townsExperiment(each);
    writeCsv(csv, trials);
    tell(json, {{"sets", summaryBySet(trials)},
                {"walls_of_towns", summaryBySet(towns)},
                {"slope_of_time", slopeOf(towns)}});
}

void ExperimentCommand::placeTrust(OutputSet &files, std::ostream &csv) const {
    std::ostream &json = open(files, ".json");
    std::vector<vectorlib::CarmenLog> read;
    for (const std::string &log : logs)
        read.push_back(readLog(log));
    std::optional<vectorlib::CarmenLog> strange;
    if (!others.empty())
        strange = readLog(others[0]);
    const std::vector<PlaceTrial> trials =
        placeTrustTrials(read, strange ? &*strange : nullptr, allWorlds(), options);
    writeCsv(csv, trials);
    tell(json, trustSummary(trials));
}

void ExperimentCommand::poseTrust(OutputSet &files, std::ostream &csv) const {
    std::ostream &json = open(files, ".json");
    struct NamedLog {
        std::string name;
        bool isStrange;
        vectorlib::CarmenLog log;
    };
    std::vector<NamedLog> read;
    std::vector<std::size_t> steps{countPoses(options.runs)};
    for (const auto *of : {&logs, &others}) {
        const std::vector<std::string> names = setNames(*of);
        for (std::size_t i = 0; i < of->size(); ++i) {
            read.push_back({names[i], of == &others, readLog((*of)[i])});
            steps.push_back(countPoses(read.back().log));
        }
    }
    ProgressParts parts(options.progress, steps);
    std::vector<PoseTrial> trials = posesOfDrawnDrives(options.seed, options.runs, parts.next());
    for (const NamedLog &of : read)
        for (PoseTrial &trial : posesOfLog(of.name, of.log, of.isStrange, parts.next()))
            trials.push_back(std::move(trial));
    writeCsv(csv, trials);
    tell(json, poseTrustSummary(trials));
}

} // namespace hermes::experiments
